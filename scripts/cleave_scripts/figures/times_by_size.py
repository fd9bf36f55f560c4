"""Figure 4 of the paper: average t_s against the number of rocks, with fitted growth exponents."""
import dataclasses
import math

import numpy

from cleave_scripts.figures import looks, style
from cleave_scripts.figures.choose import provenance, scenes_with
from cleave_scripts.figures.tree import NoData
from cleave_scripts.results.paper import PAPER

SCENE = PAPER["figure4"]["scene"]
SIZES = ("bodies", "scene_options")  # what differs between the sizes


@dataclasses.dataclass
class Fit:
    """y = factor x^exponent; error is the standard error of the exponent, nan from two points."""

    exponent: float
    error: float
    factor: float


def fit_power(x, y):
    """Least squares on the logarithms."""
    x, y = numpy.log(x), numpy.log(y)
    spread = ((x - x.mean())**2).sum()
    exponent = ((x - x.mean()) * (y - y.mean())).sum() / spread
    rest = y - y.mean() - exponent * (x - x.mean())
    error = math.sqrt((rest**2).sum() / (len(x) - 2) / spread) if len(x) > 2 else math.nan
    return Fit(exponent, error, math.exp(y.mean() - exponent * x.mean()))


def sizes(blocks, solver):
    """{number of bodies: blocks} of rock piles that differ in nothing else; those under scaling/ if any."""
    families = {}
    if any(block.is_scaling for block in blocks):
        blocks = [block for block in blocks if block.is_scaling]
    for block in blocks:
        part = block.of_solver(solver) if block.scene == SCENE and "bodies" in block.rows else None
        if part is None or not part.rows["bodies"].notna().any():
            continue
        setup = frozenset(entry for entry in part.setup if entry[0] not in SIZES)
        family = families.setdefault((setup, part.threads, part.label), {})
        family.setdefault(int(part.rows["bodies"].iloc[0]), []).append(part)
    if not families:
        raise NoData(f"no rows of scene {SCENE}, solver {solver}")
    best = max(families.values(), key=len)
    if len(best) < 2:
        raise NoData(f"{SCENE} was run with one number of bodies only; scripts/scaling runs 50 to 800")
    return dict(sorted(best.items()))


def draw(data):
    groups = sizes(data.blocks, data.solver)
    scenes, gaps = scenes_with({f"{SCENE} {size}": group for size, group in groups.items()}, "t_s_ms")
    rows = {size: scenes[f"{SCENE} {size}"] for size in groups if f"{SCENE} {size}" in scenes}
    names = looks.partitioners_in(name for frame in rows.values() for name in frame["partitioner"])
    figure, axes = style.panels(len(names), 3, 3.0, sharey=True)
    for ax, partitioner in zip(axes, names):
        _panel(ax, partitioner, rows)
    for ax in axes[::3]:
        ax.set_ylabel("$t_s$ per step, ms")
    return figure, (
        "Average t_s against the number of rocks n. Points are means over the measured steps, lines reach "
        "from the lower to the upper quartile; the exponents of the curves are fitted to the logarithms of "
        "the means (± standard "
        "error). " + gaps + provenance({f"{size} rocks": group for size, group in groups.items()}))


def _panel(ax, partitioner, rows):
    refiners = looks.refiners_in(
        name for frame in rows.values() for name in frame.loc[frame["partitioner"] == partitioner, "refiner"])
    for index, refiner in enumerate(refiners):
        look = looks.line_look(partitioner, refiner)
        times = {
            size: frame.loc[(frame["partitioner"] == partitioner) & (frame["refiner"] == refiner), "t_s_ms"]
            for size, frame in rows.items()
        }
        times = {size: values for size, values in times.items() if len(values) and values.mean() > 0}
        x = numpy.array(list(times), float)
        means = numpy.array([values.mean() for values in times.values()])
        label, shift = refiner, 1 + 0.025 * (index - (len(refiners) - 1) / 2)
        if len(x) > 1:
            fit = fit_power(x, means)
            error = "" if math.isnan(fit.error) else rf" \pm {fit.error:.2f}"
            label = rf"{refiner}: $n^{{{fit.exponent:.2f}{error}}}$"
            ax.plot(x, fit.factor * x**fit.exponent, color=look["color"], linestyle=look["linestyle"])
        ax.vlines(x * shift, [values.quantile(0.25) for values in times.values()],
                  [values.quantile(0.75) for values in times.values()],
                  color=look["color"],
                  linewidth=0.8)
        ax.plot(x * shift,
                means,
                **{
                    **look, "linestyle": "none"
                },
                markeredgecolor="white",
                markeredgewidth=0.5)
        ax.plot([], [], **look, label=label)
    ax.set(title=partitioner, xscale="log", yscale="log", xlabel="rocks $n$")
    ax.set_xticks(list(rows), list(map(str, rows)))
    ax.xaxis.set_minor_locator(style.matplotlib.ticker.NullLocator())
    ax.legend(loc="upper left", handlelength=2.6)
