"""What a better kernel does to the value of partitioning: t_s of the paper's plain over its best combination under each."""
import pandas

from cleave_scripts.figures import looks, solver_groups, style
from cleave_scripts.figures.choose import provenance
from cleave_scripts.figures.spread import interval, resampled_means
from cleave_scripts.figures.tree import NoData
from cleave_scripts.results.command_line import counted
from cleave_scripts.results.paper import BEST, PLAIN


def ratios(parts):
    """{strategy: {kernel: (ratio, low, high, steps)}} of several kernels on the steps that all their cells solved."""
    rows = pandas.concat([part.ok for part in parts], ignore_index=True)
    if not {"kernel", "t_s_ms"} <= set(rows.columns):
        raise NoData("column kernel or t_s_ms is missing")
    found = {}
    for strategy, frame in rows.groupby("asked_strategy"):
        ratios_of = _ratios_of_kernels(frame)
        if len(ratios_of) > 1:
            found[strategy] = ratios_of
    return found


def _ratios_of_kernels(rows):
    index = ["seed", "step"] if "seed" in rows else ["step"]
    times = rows.pivot_table("t_s_ms", index, ["kernel", "partitioner", "refiner"])
    cells = {kernel: [(kernel, *PLAIN), (kernel, *BEST)] for kernel in rows["kernel"].unique()}
    cells = {kernel: pair for kernel, pair in cells.items() if set(pair) <= set(times.columns)}
    times = times[sum(cells.values(), [])].dropna()
    times = times[(times > 0).all(axis=1)]
    return {kernel: _ratio(times[pair].to_numpy()) for kernel, pair in cells.items()} if len(times) else {}


def _ratio(times):
    """(ratio, low, high, steps) of two columns."""
    worse, better = resampled_means(times).T
    return times[:, 0].mean() / times[:, 1].mean(), *interval(worse / better), len(times)


def draw(data):
    bars, used = [], {}  # (text, {kernel: ratio})
    for name, parts in solver_groups.groups(data.blocks).items():
        for strategy, of_kernels in ratios(parts).items():
            steps = next(iter(of_kernels.values()))[3]
            bars.append((f"{name}\n{strategy}, {counted(steps, 'step')}", of_kernels))
            used[name] = parts
    worse, better = " + ".join(PLAIN), " + ".join(BEST)
    if not bars:
        raise NoData(f"nowhere were both {' '.join(PLAIN)} and {' '.join(BEST)} solved under several kernels with one "
                     "strategy and setup")
    kernels = list(dict.fromkeys(kernel for _, of_kernels in bars for kernel in of_kernels))
    figure = _draw(bars, looks.marks(kernels), f"$t_s$ of {worse} over $t_s$ of {better}")
    return figure, (
        f"How much partitioning is worth under several kernels: mean t_s of {worse} over that of {better} on the same "
        f"steps; lines are 95 % intervals. At 1 (dashed) the partition does not matter. " + provenance(used))


def _draw(bars, marks, what):
    figure, ax = style.pyplot.subplots(figsize=(style.WIDTH_IN, 0.6 * len(bars) + 1.0))
    for y, (_, of_kernels) in enumerate(bars):
        for index, (kernel, (ratio, low, high, _)) in enumerate(of_kernels.items()):
            place = y + 0.24 * (index - (len(of_kernels) - 1) / 2)
            _mark(ax, place, (ratio, low, high), marks[kernel])
    ax.axvline(1, color=style.MUTED, linewidth=0.8, linestyle="--")
    ax.set_yticks(range(len(bars)), [name for name, _ in bars])
    ax.set_ylim(len(bars) - 0.5, -0.5)
    ax.tick_params(axis="y", length=0)
    ax.grid(axis="y", visible=False)
    ax.margins(x=0.12)
    ax.set_xlabel(what)
    style.legend_above(figure, [
        style.matplotlib.lines.Line2D([], [], **mark, linestyle="none", markersize=6, label=kernel)
        for kernel, mark in marks.items()
    ], columns=len(marks))
    return figure


def _mark(ax, y, values, mark):
    ratio, low, high = values
    ax.hlines(y, low, high, color=mark["color"], linewidth=1.4)
    ax.plot(ratio, y, linestyle="none", markersize=6, **mark)
    ax.annotate(f"{ratio:.2f}", (max(high, ratio), y), (5, 0),
                textcoords="offset points",
                va="center",
                bbox={
                    "facecolor": "white",
                    "linewidth": 0,
                    "pad": 0.5
                })
