"""Time against error for every solver in the data, one panel a setup that was solved by several of them."""

import numpy
import pandas

from cleave_scripts.figures import looks, style
from cleave_scripts.figures.choose import provenance
from cleave_scripts.figures.labels import Label, place
from cleave_scripts.figures.solver_labels import count_text, families, full_names, solver_of
from cleave_scripts.figures.solver_groups import MOST_PANELS, groups, of_many_solvers, shared_rows
from cleave_scripts.figures.tree import NoData
from cleave_scripts.results.steps import EXACT_LIMIT
from cleave_scripts.table import text

FLOOR = 1e-17  # where a residual of exactly 0 is drawn
CLUSTER_PX = 12  # points as close as that are named together


def points(parts):
    """One row a solver and combination: quartiles of time and residual, and the share of accepted rows.

    Rows of inexact solvers are not ok but were measured, so every row with a time and a residual counts.
    """
    rows, _ = shared_rows(parts)
    for column in ("t_s_ms", "residual_m_per_s"):
        if column not in rows:
            raise NoData(f"column {column} is missing")
    rows = rows[rows["t_s_ms"].gt(0) & rows["residual_m_per_s"].notna()]
    if "rows" in rows:
        rows = rows[~(rows["rows"] == 0)]  # a step without constraints says nothing
    rows = rows.assign(residual=rows["residual_m_per_s"].clip(lower=FLOOR), accepted=rows["status"] == "ok")
    rows["time"] = rows["t_s_ms"] + (rows["t_pr_ms"].fillna(0) if "t_pr_ms" in rows else 0)
    grouped = rows.groupby(["label", "partitioner", "refiner"])
    table = {
        f"{name}_{quantile}": grouped[name].quantile(quantile) for name in ("time", "residual")
        for quantile in (0.25, 0.5, 0.75)
    }
    more = {"accepted": grouped["accepted"].mean(), "parameters": grouped["parameters"].first()}
    return pandas.DataFrame(table | more).reset_index()


def draw(data):
    found = of_many_solvers(groups(data.blocks))
    if not found:
        raise NoData("nowhere was one scene and setup solved by more than one solver")
    shown = [(name, parts, points(parts)) for name, parts in list(found.items())[:MOST_PANELS]]
    shown = [(name, parts, table) for name, parts, table in shown if len(table)]
    if not shown:
        raise NoData("no row has both a time and a residual")
    figure, axes = _layout([table["label"].nunique() for *_, table in shown])
    for (scatter, strip), (name, _, table) in zip(axes, shown):
        _scatter(scatter, table)
        _strip(strip, table)
        scatter.set_title(name)
    solvers = {solver_of(label) for *_, table in shown for label in table["label"]}
    style.legend_above(figure, style.solver_marks(solvers), columns=len(solvers))
    for (scatter, _), (*_, table) in zip(axes, shown):
        name_points(scatter, table)
    return figure, (
        "Time against error, and the same times solver by solver, with the fastest combination in brackets. "
        "Time is t_s + t_pr, error the judge's residual; points are medians over the steps that all solvers "
        "of a panel have in common, one a solver and combination, lines quartiles. Coloured lines join the "
        "sweeps or iterations of one solver, with their numbers; the names beside a cluster stand fastest "
        "first; the broad grey staircase joins what nothing beats in both. "
        f"Dashed: {text.power(EXACT_LIMIT)} m/s, what exact means. Hollow: not accepted by the "
        f"judge in every step. A residual of 0 is drawn at {text.power(FLOOR)}. {_left_out(found)}" +
        provenance({name: parts for name, parts, _ in shown}))


def _left_out(found):
    """Sentences about what is not in the picture."""
    texts = [f"Not shown: {', '.join(list(found)[MOST_PANELS:])}. "] if len(found) > MOST_PANELS else []
    for name, parts in list(found.items())[:MOST_PANELS]:
        labels = shared_rows(parts)[1]
        texts += [f"No step of {name} in common with the others: {', '.join(labels)}. "] if labels else []
    return "".join(texts)


def _layout(counts):
    """One line of two panels for every setup, high enough for its solvers."""
    heights = [max(2.4, 0.21 * count + 0.7) for count in counts]
    figure, axes = style.pyplot.subplots(len(counts),
                                         2,
                                         squeeze=False,
                                         sharex="row",
                                         figsize=(style.WIDTH_IN, sum(heights) + 0.3),
                                         gridspec_kw={
                                             "height_ratios": heights,
                                             "width_ratios": (1, 0.9)
                                         })
    return figure, axes


def _scatter(ax, table):
    for _, row in table.iterrows():
        look = looks.solver_look(solver_of(row["label"]))
        line = {"color": look["color"], "linewidth": 0.7, "alpha": 0.6}
        ax.hlines(row["residual_0.5"], row["time_0.25"], row["time_0.75"], **line)
        ax.vlines(row["time_0.5"], row["residual_0.25"], row["residual_0.75"], **line)
        ax.plot(row["time_0.5"], row["residual_0.5"], **_mark(row), markersize=5.5)
    for solver, family in families(table).items():
        ax.plot(family["time_0.5"],
                family["residual_0.5"],
                color=looks.solver_look(solver)["color"],
                linewidth=0.9,
                zorder=1.5)
    ax.step(*front(table), where="post", color=style.GRID, linewidth=3, zorder=1)
    ax.axhline(EXACT_LIMIT, color=style.INK, linewidth=0.8, linestyle="--", zorder=1)
    ax.set(xscale="log", yscale="log", xlabel="$t_s + t_{pr}$ per step, ms", ylabel="residual, m/s")
    ax.margins(0.07)


def front(table):
    """Times and residuals of the points that no other beats in both."""
    table = table.sort_values(["time_0.5", "residual_0.5"])
    table = table[table["residual_0.5"] < table["residual_0.5"].cummin().shift(fill_value=float("inf"))]
    return table["time_0.5"], table["residual_0.5"]


def name_points(ax, table):
    """Writes how many sweeps or iterations a point of a family had, and who the others are."""
    ax.set(xlim=ax.get_xlim(), ylim=ax.get_ylim())
    names, joined = [], families(table)
    for solver, family in joined.items():
        color = looks.readable(looks.solver_look(solver)["color"])
        for index, (_, row) in enumerate(family.iterrows()):
            text = count_text(row, with_unit=index == 0)
            names.append(Label(text, (row["time_0.5"], row["residual_0.5"]), color))
    alone = table[~table["label"].map(solver_of).isin(joined)]
    names = [*_names_of_clusters(ax, alone), *names]
    start, least = front(table)
    lines = [list(zip(start.repeat(2)[1:], least.repeat(2)[:-1]))] if len(start) > 1 else []
    lines += [list(zip(family["time_0.5"], family["residual_0.5"])) for family in joined.values()]
    lines.append([(limit, EXACT_LIMIT) for limit in ax.get_xlim()])
    for _, row in table.iterrows():
        lines.append([(row[f"time_{end}"], row["residual_0.5"]) for end in ("0.25", "0.75")])
        lines.append([(row["time_0.5"], row[f"residual_{end}"]) for end in ("0.25", "0.75")])
    place(ax, names, table[["time_0.5", "residual_0.5"]].to_numpy(), lines)


def _names_of_clusters(ax, table):
    """One label for points that lie too close together for one each: the solvers there, fastest first."""
    table = table.sort_values("time_0.5")
    places = ax.transData.transform(table[["time_0.5", "residual_0.5"]].to_numpy())
    clusters = []  # of row numbers
    for index, point in enumerate(places):
        near = [
            cluster for cluster in clusters if numpy.hypot(*(places[cluster] - point).T).min() < CLUSTER_PX
        ]
        clusters = [cluster for cluster in clusters if cluster not in near] + [sum(near, []) + [index]]
    for cluster in clusters:
        rows = table.iloc[sorted(cluster)]
        first = rows.iloc[0]
        text = "\n".join(dict.fromkeys(rows["label"]))
        yield Label(text, (first["time_0.5"], first["residual_0.5"]), style.INK)


def _strip(ax, table):
    """The times again, a line a solver."""
    labels = list(table.groupby("label")["time_0.5"].min().sort_values().index)
    names, written = [], full_names(table)
    for y, label in enumerate(labels):
        rows = table[table["label"] == label]
        for index, (_, row) in enumerate(rows.iterrows()):
            place_y = y + (0.5 if len(rows) == 1 else 0.2 + 0.6 * index / (len(rows) - 1)) - 0.5
            ax.hlines(place_y, row["time_0.25"], row["time_0.75"], color=_mark(row)["color"], linewidth=0.7)
            ax.plot(row["time_0.5"], place_y, **_mark(row), markersize=4.5)
        best = rows.loc[rows["time_0.5"].idxmin()]
        ending = "" if len(rows) == 1 else f" ({best['partitioner']} {best['refiner']})"
        names.append(written[label] + ending)
    ax.set_yticks(range(len(labels)), names, fontsize=7)
    ax.set_ylim(len(labels) - 0.4, -0.6)
    ax.tick_params(axis="y", length=0)
    ax.set_xlabel("$t_s + t_{pr}$ per step, ms")


def _mark(row):
    look = looks.solver_look(solver_of(row["label"]))
    return {
        **look, "linestyle": "none",
        "markeredgecolor": look["color"],
        "markeredgewidth": 0.9,
        "markerfacecolor": look["color"] if row["accepted"] == 1 else "white"
    }
