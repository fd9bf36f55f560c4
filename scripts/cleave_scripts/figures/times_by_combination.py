"""Figure 3 of the paper: average t_s of every example and combination."""
import itertools
import statistics

import matplotlib.lines

from cleave_scripts.figures import looks, style
from cleave_scripts.figures.choose import merged_runs, provenance, scenes_with
from cleave_scripts.results.names import title

BAR_WIDTH = 0.8
MOST_LETTERS = 40  # of names side by side below a panel; more stand aslant
HIGHEST_BAR = 3  # medians of a panel's means; higher bars are cut

MEDIAN = {
    "marker": "o",
    "markersize": 3,
    "markerfacecolor": "white",
    "markeredgecolor": style.INK,
    "markeredgewidth": 0.8,
    "color": style.INK,
    "zorder": 7  # above the values at the top edge
}

BEYOND = {"marker": "^", "markersize": 4, "color": style.INK, "zorder": 6}  # a quartile outside the panel


def draw(data):
    scenes, gaps = scenes_with(data.main, "t_s_ms")
    figure, axes = style.panels(len(scenes), 2, 2.35)
    for ax, (scene, rows) in zip(axes, scenes.items()):
        ax.set_title(title(scene))
        _panel(ax, rows, merged_runs(data.main[scene]))
    refiners = looks.refiners_in(name for rows in scenes.values() for name in rows["refiner"])
    median = matplotlib.lines.Line2D([], [], **MEDIAN, linestyle="none", label="median, quartiles")
    style.legend_above(figure, [*style.refiner_patches(refiners), median], columns=5)
    caption = (
        "Average time t_s of a solve in every example and combination. Bars are means over the measured "
        "steps, dots medians, lines reach from the lower to the upper quartile over the steps; the lowest "
        "mean carries its value in bold. Bars that go out of a panel carry theirs at the top edge; an "
        "arrowhead there: the upper quartile lies further up, and so does the median where its dot is "
        "missing. ")
    return figure, caption + gaps + provenance({title(scene): data.main[scene] for scene in scenes})


def _panel(ax, rows, all_rows):
    """rows: with status ok; all_rows: also the failed ones, which get a mark in place of a bar."""
    partitioners, refiners = looks.partitioners_in(all_rows["partitioner"]), looks.refiners_in(
        all_rows["refiner"])
    width = BAR_WIDTH / len(refiners)
    times = dict(list(rows.groupby(["partitioner", "refiner"])["t_s_ms"]))
    means = {name: values.mean() for name, values in times.items()}
    lowest = min(means, key=means.get)
    # One slow combination must not flatten the others.
    highest = HIGHEST_BAR * statistics.median(means.values())
    uppers = {name: values.quantile(0.75) for name, values in times.items()}
    top = 1.12 * max(height for name, mean in means.items() if mean <= highest
                     for height in (mean, uppers[name]) if height <= highest)
    ax.set_ylim(0, top or 1)
    for name in itertools.product(partitioners, refiners):
        x = partitioners.index(name[0]) + (refiners.index(name[1]) - (len(refiners) - 1) / 2) * width
        if name in times:
            _bar(ax, x, width, name, times[name], marked=name == lowest)
            if means[name] > top:
                _cut_label(ax, x, means[name])
            if uppers[name] > top:
                ax.plot(x, 1, **BEYOND, transform=ax.get_xaxis_transform(), clip_on=False)
        else:
            run = ((all_rows["partitioner"] == name[0]) & (all_rows["refiner"] == name[1])).any()
            ax.text(x,
                    0.02,
                    "no step ok" if run else "no data",
                    transform=ax.get_xaxis_transform(),
                    rotation=90,
                    ha="center",
                    va="bottom",
                    fontsize=6.5,
                    color=style.MUTED)
    crowded = sum(map(len, partitioners)) > MOST_LETTERS
    ax.set_xticks(range(len(partitioners)), partitioners, rotation=30 * crowded, ha="right" if crowded else "center")
    ax.tick_params(axis="x", length=0)
    ax.grid(axis="x", visible=False)
    ax.set_ylabel("$t_s$ per step, ms")


def _bar(ax, x, width, name, times, marked):
    lower, median, upper = times.quantile([0.25, 0.5, 0.75])
    ax.bar(x, times.mean(), 0.92 * width, **looks.bar_look(*name))
    ax.vlines(x, lower, upper, color=style.INK, linewidth=0.9)
    ax.plot(x, median, **MEDIAN)
    if marked:
        height = min(max(times.mean(), upper), 0.9 * ax.get_ylim()[1])
        ax.annotate(style.short(times.mean()), (x, height), (0, 3),
                    textcoords="offset points",
                    ha="center",
                    va="bottom",
                    fontsize=7.5,
                    fontweight="bold",
                    bbox={
                        "facecolor": "white",
                        "alpha": 0.8,
                        "linewidth": 0,
                        "pad": 0.8
                    })


def _cut_label(ax, x, mean):
    ax.text(x,
            0.95,
            style.short(mean),
            transform=ax.get_xaxis_transform(),
            rotation=90,
            ha="center",
            va="top",
            fontsize=7,
            bbox={
                "facecolor": "white",
                "linewidth": 0,
                "pad": 0.6
            })
