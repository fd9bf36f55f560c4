"""Time against error for every solver in the data, one panel a setup that was solved by several of them."""
import pandas

from cleave_results import EXACT_LIMIT
from figures import style
from figures.choose import provenance
from figures.solver_groups import MOST_PANELS, groups, of_many_solvers, shared_rows
from figures.tree import NoData

FLOOR = 1e-17  # where a residual of exactly 0 is drawn


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
    return pandas.DataFrame({**table, "accepted": grouped["accepted"].mean()}).reset_index()


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
        labels = list(table.groupby("label")["time_0.5"].min().sort_values().index)
        markers = {label: style.MARKERS[index % len(style.MARKERS)] for index, label in enumerate(labels)}
        _scatter(scatter, table, markers)
        _strip(strip, table, markers)
        scatter.set_title(name)
    names = style.partitioners_in(name for *_, table in shown for name in table["partitioner"])
    style.legend_above(figure, style.partitioner_patches(names), columns=len(names))
    return figure, (
        "Time against error, and the same times solver by solver. Time is t_s + t_pr, error the judge's "
        "residual; points are medians over the steps that all solvers of a panel have in common, one a "
        "solver and combination, lines quartiles; the grey staircase joins what nothing beats in both. "
        f"Dashed: {_power(EXACT_LIMIT)} m/s, what exact means. Hollow: not accepted by the judge in "
        f"every step. A residual of 0 is drawn at {_power(FLOOR)}. {_left_out(found)}" +
        provenance({name: parts for name, parts, _ in shown}))


def _left_out(found):
    """Sentences about what is not in the picture."""
    texts = [f"Not shown: {', '.join(list(found)[MOST_PANELS:])}. "] if len(found) > MOST_PANELS else []
    for name, parts in list(found.items())[:MOST_PANELS]:
        labels = shared_rows(parts)[1]
        texts += [f"No step of {name} in common with the others: {', '.join(labels)}. "] if labels else []
    return "".join(texts)


def _power(value):
    return f"{value:.0e}".replace("e-0", "e-")


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


def _scatter(ax, table, markers):
    for _, row in table.iterrows():
        base = style.color(row["partitioner"])
        ax.hlines(row["residual_0.5"],
                  row["time_0.25"],
                  row["time_0.75"],
                  color=base,
                  linewidth=0.7,
                  alpha=0.6)
        ax.vlines(row["time_0.5"],
                  row["residual_0.25"],
                  row["residual_0.75"],
                  color=base,
                  linewidth=0.7,
                  alpha=0.6)
        ax.plot(row["time_0.5"], row["residual_0.5"], markers[row["label"]], **_face(row), markersize=5.5)
    front = table.sort_values(["time_0.5", "residual_0.5"])
    front = front[front["residual_0.5"] < front["residual_0.5"].cummin().shift(fill_value=float("inf"))]
    ax.step(front["time_0.5"], front["residual_0.5"], where="post", color=style.MUTED, linewidth=1, zorder=1)
    ax.axhline(EXACT_LIMIT, color=style.INK, linewidth=0.8, linestyle="--", zorder=1)
    ax.set(xscale="log", yscale="log", xlabel="$t_s + t_{pr}$ per step, ms", ylabel="residual, m/s")
    _name_inexact(ax, table)


def _name_inexact(ax, table):
    """The names of solvers that lie above the limit, where there is room; the others stand close together.

    Downwards at the one that has most points there, which are above no other; upwards at the others.
    """
    inexact = table[table["residual_0.5"] > EXACT_LIMIT]
    if inexact.empty:
        return
    inexact = inexact.sort_values("time_0.5")
    families = inexact["label"].str.partition(",")[0]
    for first, family, (_, row) in zip(~families.duplicated(), families, inexact.iterrows()):
        down = family == families.mode()[0]
        text = row["label"] if first else row["label"].removeprefix(f"{family}, ")
        ax.annotate(text, (row["time_0.5"], row["residual_0.5"]), (3, -5 if down else 4),
                    textcoords="offset points",
                    rotation=-35 if down else 35,
                    rotation_mode="anchor",
                    va="top" if down else "bottom",
                    fontsize=6.5,
                    color=style.MUTED)
    least, most = ax.get_ylim()
    ax.set_ylim(least, most * (most / least)**(0.08 if families.nunique() < 2 else 0.2))


def _strip(ax, table, markers):
    """The times again, a line a solver."""
    for y, (label, marker) in enumerate(markers.items()):
        rows = table[table["label"] == label]
        for index, (_, row) in enumerate(rows.iterrows()):
            place = y + (0.5 if len(rows) == 1 else 0.2 + 0.6 * index / (len(rows) - 1)) - 0.5
            ax.hlines(place,
                      row["time_0.25"],
                      row["time_0.75"],
                      color=style.color(row["partitioner"]),
                      linewidth=0.7)
            ax.plot(row["time_0.5"], place, marker, **_face(row), markersize=4)
    ax.set_yticks(range(len(markers)), list(markers), fontsize=7)
    ax.set_ylim(len(markers) - 0.4, -0.6)
    ax.tick_params(axis="y", length=0)
    ax.set_xlabel("$t_s + t_{pr}$ per step, ms")


def _face(row):
    base = style.color(row["partitioner"])
    return {
        "markeredgecolor": base,
        "markeredgewidth": 0.9,
        "markerfacecolor": base if row["accepted"] == 1 else "white"
    }
