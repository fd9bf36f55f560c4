"""The stability ladder as a heat map: for every series and solver the first rung that fails."""
import math
import re

import numpy

from cleave_scripts.figures import style
from cleave_scripts.figures.tree import NoData

JUDGED = {
    "status": "Exact on every step",
    "physics": "Moves as the closed form says"
}  # columns of ladder.csv
EXPLAINED = {
    "status": "Exact: the judge accepted every step.",
    "physics": "Motion: height, joint gaps, penetration and energy are those of the closed form for the "
               "compliance."
}

TEXT_PT, WIDEST_TEXT = 7.5, 0.85  # of the texts of cells; the share of a cell that they may take


def series_of(ladder):
    """What one climbs: the rung's name where it has several values, else the parameter."""
    return "rung" if (ladder.groupby("rung", sort=False)["value"].nunique() > 1).any() else "parameter"


def climb(ladder, series, solver, column="status"):
    """(share of the rungs below the first failing one, its value or None); None where nothing was run."""
    rows = ladder[(ladder["series"] == series) & (ladder["solver"] == solver)]
    if rows.empty:
        return None
    # A rung holds when every row of it is ok; rungs stand in the order of the file, easiest first.
    holds = (rows[column] == "ok").groupby(rows["value"], sort=False).all()
    if holds.all():
        return 1.0, None
    first = int(numpy.argmin(holds.to_numpy()))
    return first / len(holds), holds.index[first]


def draw(data):
    ladder = data.tree.ladder
    if ladder is None or ladder.empty:
        raise NoData("no ladder.csv with rows; scripts/ladder writes one")
    ladder = ladder.assign(series=ladder[series_of(ladder)])
    names, solvers = list(dict.fromkeys(ladder["series"])), list(dict.fromkeys(ladder["solver"]))
    judged = {column: title for column, title in JUDGED.items() if column in ladder}
    figure, axes = style.pyplot.subplots(len(judged),
                                         1,
                                         squeeze=False,
                                         figsize=(min(style.WIDTH_IN, 0.6 * len(solvers) + 3.2),
                                                  (0.21 * len(names) + 1.3) * len(judged) + 0.3))
    for ax, (column, title) in zip(axes.flat, judged.items()):
        cells = {(name, solver): climb(ladder, name, solver, column) for name in names for solver in solvers}
        image = _map(ax, cells, [_with_parameter(ladder, name) for name in names], solvers)
        ax.set_title(title)
    figure.colorbar(image, ax=axes, label="share of rungs held", pad=0.01,
                    fraction=0.03).outline.set_visible(False)
    for ax in axes.flat:
        _fit_texts(ax)
    rungs = ladder[["series", "value"]].drop_duplicates().shape[0]
    return figure, (
        f"The stability ladder, {rungs} rungs, every solver in a world of its own. A cell names the value at "
        "which the solver fails first, 'holds' where it climbs to the top; the lighter, the further. "
        f"{' '.join(EXPLAINED[column] for column in judged)} Hatched: not run.")


def _map(ax, cells, names, solvers):
    """names: of the series, in the order of the cells."""
    table = list(cells.values())
    shares = numpy.array([math.nan if cell is None else cell[0] for cell in table])
    image = ax.pcolormesh(shares.reshape(len(names), len(solvers)),
                          cmap="cividis",
                          vmin=0,
                          vmax=1,
                          edgecolors="white",
                          linewidth=1.5)
    for index, cell in enumerate(table):
        _cell_text(ax, index % len(solvers), index // len(solvers), cell)
    ax.set_yticks(numpy.arange(len(names)) + 0.5, names)
    ax.set_xticks(numpy.arange(len(solvers)) + 0.5, solvers, rotation=30, ha="left", rotation_mode="anchor")
    ax.xaxis.tick_top()
    ax.invert_yaxis()
    ax.grid(False)
    ax.tick_params(length=0)
    ax.spines[:].set_visible(False)
    return image


def _cell_text(ax, x, y, cell):
    if cell is None:
        ax.add_patch(
            style.matplotlib.patches.Rectangle((x, y),
                                               1,
                                               1,
                                               facecolor="white",
                                               edgecolor=style.GRID,
                                               hatch="////",
                                               linewidth=0))
        return
    share, value = cell
    ax.text(x + 0.5,
            y + 0.5,
            "holds" if value is None else _short(value),
            ha="center",
            va="center",
            fontsize=TEXT_PT,
            color="white" if share < 0.55 else style.INK)


def _fit_texts(ax):
    """One size for all texts of a map, small enough for the widest to leave the margins of its cell free."""
    ax.figure.draw_without_rendering()
    (left, top), (right, bottom) = ax.transData.transform([(0, 0), (1, 1)])
    extents = [text.get_window_extent() for text in ax.texts]
    share = max((max(extent.width / (right - left), extent.height / (top - bottom)) for extent in extents),
                default=0)
    for text in ax.texts if share > WIDEST_TEXT else ():
        text.set_fontsize(TEXT_PT * WIDEST_TEXT / share)


def _short(value):
    """Three digits, and 1e5 for what is longer."""
    try:
        return re.sub(r"e([+-])0*", r"e\1", f"{float(value):.3g}").replace("e+", "e")
    except ValueError:
        return str(value)


def _with_parameter(ladder, name):
    parameters = ladder.loc[ladder["series"] == name, "parameter"].unique()
    text = name if list(parameters) == [name] else f"{name} ({', '.join(parameters)})"
    return text.replace("_", " ")
