"""The stability ladder as a heat map: for every series and solver the first rung that fails."""
import math
import re

import numpy

from figures import style
from figures.tree import NoData

JUDGED = {
    "status": "Exact on every step",
    "physics": "Moves as the closed form says"
}  # columns of ladder.csv
EXPLAINED = {
    "status": "Exact: the judge accepted every step.",
    "physics": "Motion: height, joint gaps, penetration and energy are those of the closed form for the "
               "compliance."
}


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
                                         sharex=True,
                                         squeeze=False,
                                         figsize=(min(style.WIDTH_IN, 0.8 * len(names) + 2.8),
                                                  (0.27 * len(solvers) + 0.3) * len(judged) + 1.5))
    for ax, (column, title) in zip(axes.flat, judged.items()):
        cells = {(solver, name): climb(ladder, name, solver, column) for solver in solvers for name in names}
        image = _map(ax, cells, names, solvers)
        ax.set_title(title)
    axes.flat[-1].set_xticks(numpy.arange(len(names)) + 0.5,
                             [_with_parameter(ladder, name) for name in names],
                             rotation=40,
                             ha="right",
                             rotation_mode="anchor")
    figure.colorbar(image, ax=axes, label="share of rungs held", pad=0.01,
                    fraction=0.03).outline.set_visible(False)
    rungs = ladder[["series", "value"]].drop_duplicates().shape[0]
    return figure, (
        f"The stability ladder, {rungs} rungs, every solver in a world of its own. A cell names the value at "
        "which the solver fails first, 'holds' where it climbs to the top; the lighter, the further. "
        f"{' '.join(EXPLAINED[column] for column in judged)} Hatched: not run.")


def _map(ax, cells, names, solvers):
    shares = numpy.array(
        [[math.nan if cells[solver, name] is None else cells[solver, name][0]
          for name in names]
         for solver in solvers])
    image = ax.pcolormesh(shares, cmap="cividis", vmin=0, vmax=1, edgecolors="white", linewidth=1.5)
    for (solver, name), cell in cells.items():
        _cell_text(ax, names.index(name), solvers.index(solver), cell)
    ax.set_yticks(numpy.arange(len(solvers)) + 0.5, solvers)
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
            fontsize=7,
            color="white" if share < 0.55 else style.INK)


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
