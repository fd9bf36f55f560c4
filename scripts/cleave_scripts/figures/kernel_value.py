"""What a better kernel does to the value of partitioning: t_s of mindp + none over mix + fm under each."""
import pandas

from cleave_scripts.figures import solver_groups, style
from cleave_scripts.figures.choose import provenance
from cleave_scripts.figures.spread import interval, resampled_means
from cleave_scripts.figures.tree import NoData
from cleave_scripts.results.command_line import counted

KERNELS = ("schur-rows", "schur-bodies")
WORSE, BETTER = ("mindp", "none"), ("mix", "fm")
SOLVERS = {"schur-rows": "schur", "schur-bodies": "pivot:schur-bodies"}  # whose look a kernel has


def strategy_of(solver, kernel):
    """The strategy a solver was asked for: 'pivot:schur-rows' and 'schur' are pivot."""
    name = solver.removesuffix(":" + kernel)
    return "pivot" if name == "schur" else name


def ratios(parts):
    """{strategy: [(ratio, low, high, steps) of each kernel]} on the steps that all four cells solved."""
    rows = pandas.concat([part.ok for part in parts], ignore_index=True)
    if not {"kernel", "t_s_ms"} <= set(rows.columns):
        raise NoData("column kernel or t_s_ms is missing")
    rows = rows[rows["kernel"].isin(KERNELS)]
    strategies = [strategy_of(*names) for names in zip(rows["solver"], rows["kernel"])]
    index = ["seed", "step"] if "seed" in rows else ["step"]
    cells = [(kernel, *combination) for kernel in KERNELS for combination in (WORSE, BETTER)]
    found = {}
    for strategy, frame in rows.groupby(strategies):
        times = frame.pivot_table("t_s_ms", index, ["kernel", "partitioner", "refiner"])
        if set(cells) <= set(times.columns):
            times = times[cells].dropna().to_numpy()
            times = times[(times > 0).all(axis=1)]
            if len(times):
                found[strategy] = [_ratio(times[:, :2]), _ratio(times[:, 2:])]
    return found


def _ratio(times):
    """(ratio, low, high, steps) of two columns."""
    worse, better = resampled_means(times).T
    return times[:, 0].mean() / times[:, 1].mean(), *interval(worse / better), len(times)


def draw(data):
    bars = []
    used = {}
    for name, parts in solver_groups.groups(data.blocks).items():
        found = ratios(parts)
        for strategy, pair in found.items():
            bars.append((f"{name}\n{strategy}, {counted(pair[0][3], 'step')}", pair))
            used[name] = parts
    if not bars:
        raise NoData(
            f"nowhere were both {' '.join(WORSE)} and {' '.join(BETTER)} solved under {KERNELS[0]} and "
            f"{KERNELS[1]} with one strategy and setup")
    figure, ax = style.pyplot.subplots(figsize=(style.WIDTH_IN, 0.6 * len(bars) + 1.0))
    for y, (_, pair) in enumerate(bars):
        for shift, kernel, (ratio, low, high, _) in zip((-0.12, 0.12), KERNELS, pair):
            look = style.solver_look(SOLVERS[kernel])
            ax.hlines(y + shift, low, high, color=look["color"], linewidth=1.4)
            ax.plot(ratio,
                    y + shift,
                    linestyle="none",
                    markersize=6,
                    **look,
                    label=kernel if y == 0 else None)
            ax.annotate(f"{ratio:.2f}", (max(high, ratio), y + shift), (5, 0),
                        textcoords="offset points",
                        va="center",
                        bbox={
                            "facecolor": "white",
                            "linewidth": 0,
                            "pad": 0.5
                        })
    ax.axvline(1, color=style.MUTED, linewidth=0.8, linestyle="--")
    ax.set_yticks(range(len(bars)), [name for name, _ in bars])
    ax.set_ylim(len(bars) - 0.5, -0.5)
    ax.tick_params(axis="y", length=0)
    ax.grid(axis="y", visible=False)
    ax.margins(x=0.12)
    ax.set_xlabel(f"$t_s$ of {' + '.join(WORSE)} over $t_s$ of {' + '.join(BETTER)}")
    style.legend_above(figure, ax.get_legend_handles_labels()[0], columns=2)
    return figure, (
        f"How much partitioning is worth under two kernels: mean t_s of {' + '.join(WORSE)} over that of "
        f"{' + '.join(BETTER)} on the same steps; lines are 95 % intervals. At 1 (dashed) the partition "
        f"does not matter. " + provenance(used))
