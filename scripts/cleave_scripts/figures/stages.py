"""Where t_s goes: the named stages of the solve, stacked. The stages are read from the header."""
import re
import statistics

import pandas

from cleave_scripts.figures import looks, style
from cleave_scripts.figures.choose import provenance, scenes_with
from cleave_scripts.figures.solver_groups import MOST_PANELS, groups, shared_rows
from cleave_scripts.figures.tree import NoData
from cleave_scripts.results.names import NO_PARTITIONER, title

COLUMNS = 2
LONGEST_BAR = 3  # medians of a panel; longer bars are cut
CUT = "Bars that go out of a panel carry their whole length. "
STAGE = re.compile(r"t_s_(?!min_|model_)(\w+)_ms")


def stage_columns(rows):
    """{column: name of the stage} of the stages that took any time, in the order of the header."""
    found = {column: STAGE.fullmatch(column).group(1) for column in rows.columns if STAGE.fullmatch(column)}
    return {column: name for column, name in found.items() if rows[column].gt(0).any()}


def draw_combinations(data):
    scenes, gaps = scenes_with(data.main, "t_s_ms")
    bars = {
        title(scene): [((partitioner, refiner), f"{partitioner} {refiner}", part)
                       for partitioner in looks.partitioners_in(frame["partitioner"])
                       for refiner in looks.refiners_in(frame["refiner"])
                       if len(part := frame[(frame["partitioner"] == partitioner) &
                                            (frame["refiner"] == refiner)])
                      ] for scene, frame in scenes.items()
    }
    return _draw(bars), ("Mean time of the stages of a solve, combination by combination. " + CUT + gaps +
                         provenance({title(scene): data.main[scene] for scene in scenes}))


def draw_solvers(data):
    """For every solver its fastest combination, in setups that several solvers have solved."""
    found = dict(list(groups(data.blocks).items())[:MOST_PANELS])
    if not found:
        raise NoData("nowhere was one scene and setup solved by more than one solver")
    frames = {name: shared_rows(parts)[0] for name, parts in found.items()}
    bars = {
        name: _fastest(frame.dropna(subset=["t_s_ms"])) for name, frame in frames.items() if "t_s_ms" in frame
    }
    bars = {name: panel for name, panel in bars.items() if panel}
    if not bars:
        raise NoData("column t_s_ms is missing or empty")
    return _draw(bars), (
        "Mean time of the stages of a solve for every solver, each with its fastest combination; "
        "rows that are not ok count too. " + CUT +
        provenance({name: parts for name, parts in found.items() if name in bars}))


def _fastest(rows):
    bars = []
    for label, frame in rows.groupby("label"):
        combination = frame.groupby(["partitioner", "refiner"])["t_s_ms"].mean().idxmin()
        part = frame[(frame["partitioner"] == combination[0]) & (frame["refiner"] == combination[1])]
        name = label if combination[0] == NO_PARTITIONER else f"{label} ({' '.join(combination)})"
        bars.append((combination, name, part))
    return sorted(bars, key=lambda bar: bar[2]["t_s_ms"].mean())


def _draw(panels):
    frames = pandas.concat([part for bars in panels.values() for *_, part in bars], ignore_index=True)
    stages = stage_columns(frames)
    if not stages:
        raise NoData("no column t_s_<stage>_ms with a time")
    stage_colors = looks.stage_colors(stages.values())
    colors = {column: stage_colors[stage] for column, stage in stages.items()}
    counts = list(map(len, panels.values()))
    most_of_line = [max(counts[first:first + COLUMNS]) for first in range(0, len(counts), COLUMNS)]
    heights = [0.165 * most + 0.75 for most in most_of_line]
    figure, axes = style.panels(len(panels),
                                COLUMNS,
                                sum(heights) / len(heights),
                                gridspec_kw={"height_ratios": heights})
    for index, (ax, (name, bars)) in enumerate(zip(axes, panels.items())):
        ax.set_title(name)
        _panel(ax, bars, colors)
        ax.set_ylim(most_of_line[index // COLUMNS] - 0.4, -0.6)  # bars of one width in all panels
    handles = [
        style.matplotlib.patches.Patch(color=colors[column], label=stage.replace("_", " "))
        for column, stage in stages.items()
    ]
    style.legend_above(figure, handles, columns=5)
    return figure


def _panel(ax, bars, colors):
    totals = [part["t_s_ms"].mean() for *_, part in bars]
    # One slow solver must not flatten the others: a bar far beyond the median is cut and says its length.
    limit = 1.12 * max(total for total in totals if total <= LONGEST_BAR * statistics.median(totals))
    for y, ((*_, part), total) in enumerate(zip(bars, totals)):
        left = 0.0
        for column, stage_color in colors.items():
            width = part[column].mean() if column in part else 0.0
            if width > 0:
                ax.barh(y, width, 0.78, left, color=stage_color)
                left += width
        if total > limit:
            # The bar is seen on both sides of its length, so that it goes out of the picture.
            ax.text(0.9 * limit,
                    y,
                    f"{style.short(total)} ms",
                    ha="right",
                    va="center",
                    fontsize=7,
                    bbox={
                        "facecolor": "white",
                        "linewidth": 0,
                        "pad": 1
                    })
    ax.set_xlim(0, limit or 1)
    ax.set_yticks(range(len(bars)), [name for _, name, _ in bars], fontsize=7)
    for tick, (combination, *_) in zip(ax.get_yticklabels(), bars):
        tick.set_color(looks.readable(looks.color(combination[0])))
    ax.tick_params(axis="y", length=0)
    ax.grid(axis="y", visible=False)
    ax.set_xlabel("mean $t_s$ per step, ms")
