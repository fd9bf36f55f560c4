"""What a claim's figure is in measured rows: its value, and the noise of it."""
import numpy

from cleave_scripts.figures.spread import CONFIDENCE, interval, resample_indices
from cleave_scripts.figures.tree import NoData

PEAK_SHARE = 0.05


def tables(claim, places, column, run):
    """{place: frame of steps x (partitioner, refiner)} over the steps that all its cells have solved.

    places: {place: blocks that repeat one run}; run: which of the repeats.
    """
    found = {}
    for place in dict.fromkeys(cell[0] for cell in claim.cells):
        if place not in places:
            raise NoData(f"no rows of {place}")
        rows = _with_mflop(places[place][run].ok)
        if column not in rows or not rows[column].notna().any():
            raise NoData(f"column {column} is missing")
        names = [(cell[1], cell[2]) for cell in claim.cells if cell[0] == place]
        steps = ["seed", "step"] if "seed" in rows else ["step"]
        table = rows.pivot_table(column, steps, ["partitioner", "refiner"])
        absent = [name for name in names if name not in table.columns]
        if absent:
            raise NoData(f"no row with status ok of {', '.join(map(' '.join, absent))} in {place}")
        found[place] = table[names].dropna()
        if found[place].empty:
            raise NoData(f"no step of {place} that all its cells solved")
    return found


def _with_mflop(rows):
    columns = ["factor_mflop_local", "factor_mflop_interface"]
    return rows.assign(
        factor_mflop=rows[columns].sum(axis=1, skipna=False)) if set(columns) <= set(rows) else rows


def value(claim, found):
    """The claim's figure on these tables."""
    every_step = {place: numpy.arange(len(table))[None, :] for place, table in found.items()}
    return float(_figure(claim.figure, _reduced(claim, found, every_step))[0])


def noise(claim, found):
    """The CONFIDENCE interval of the figure under resampled steps.

    The least of k figures is below each of them, and noise pulls it further down. So its interval is not that
    of the least, but the least ends of the k intervals, each at 1 - (1 - CONFIDENCE) / k.
    """
    samples = _reduced(claim, found, {place: resample_indices(len(table), place) for place, table in found.items()})
    parts = getattr(claim.figure, "parts", (claim.figure,))
    confidence = 1 - (1 - CONFIDENCE) / len(parts)
    ends = [interval(_figure(part, samples), confidence) for part in parts]
    return min(low for low, _ in ends), min(high for _, high in ends)


def _reduced(claim, found, indices):
    """{cell: array of its statistic, one entry a row of indices}"""
    reduce = STATISTICS[claim.statistic]
    return {(place, *name): reduce(table[name].to_numpy()[indices[place]]) for place, table in found.items()
            for name in table.columns}


def _figure(figure, reduced):
    with numpy.errstate(divide="ignore", invalid="ignore"):
        return numpy.asarray(figure(reduced.__getitem__), float)


def _peak(values):
    count = max(1, round(PEAK_SHARE * values.shape[1]))
    return numpy.sort(values, axis=1)[:, -count:].mean(axis=1)


STATISTICS = {
    "mean": lambda values: values.mean(axis=1),
    "peak": _peak,
    "most": lambda values: values.max(axis=1)
}
