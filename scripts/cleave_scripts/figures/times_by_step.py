"""Figure 5 of the paper: t_s of every measured step on Log Tower, mindp with each refiner, peaks marked."""
from cleave_scripts.figures import style
from cleave_scripts.figures.choose import first_runs, most_steps, provenance, title
from cleave_scripts.figures.tree import need

SCENE, PARTITIONER = "log_tower", "mindp"


def longest_runs(data):
    """The blocks of the run that measured most steps; more than one where it was repeated."""
    return most_steps(data.blocks, SCENE, data.solver, PARTITIONER)


def draw(data):
    blocks = longest_runs(data)
    measured = first_runs(blocks)
    measured = measured[measured["partitioner"] == PARTITIONER]
    rows = need(measured[measured["status"] == "ok"], "step", "t_s_ms")
    refiners = style.refiners_in(rows["refiner"])
    # Over all measured steps, so that a failed one leaves a gap in the curve.
    steps = sorted(measured["step"].dropna().unique())
    curves = {
        refiner: rows[rows["refiner"] == refiner].groupby("step")["t_s_ms"].median().reindex(steps)
        for refiner in refiners
    }
    figure, axes = style.pyplot.subplots(len(refiners),
                                         1,
                                         sharex=True,
                                         sharey=True,
                                         squeeze=False,
                                         figsize=(style.WIDTH_IN, 1.45 * len(refiners) + 0.4))
    for ax, (refiner, curve) in zip(axes.flat, curves.items()):
        if refiner != refiners[0]:
            ax.fill_between(steps, curves[refiners[0]], color=style.GRID, linewidth=0)
        _curve(ax, refiner, curve)
    axes.flat[0].set_ylim(0, 1.15 * max(curve.max() for curve in curves.values()) or 1)
    axes.flat[-1].set(xlabel="step", xlim=(min(0, steps[0]), steps[-1] + 1))
    failed = " Crosses: steps without a row that is ok." if any(
        curve.isna().any() for curve in curves.values()) else ""
    return figure, (
        f"Time t_s of each measured step of {title(SCENE)}, partitioner {PARTITIONER} with each refiner. "
        f"Triangles mark the highest peak, the grey area is {PARTITIONER} + {refiners[0]} again.{failed} " +
        provenance({title(SCENE): blocks}))


def _curve(ax, refiner, curve):
    look = style.line_look(PARTITIONER, refiner)
    few = len(curve) <= 80
    ax.plot(curve.index,
            curve,
            **{
                **look, "marker": look["marker"] if few else None
            },
            markersize=3,
            linewidth=1.1)
    for step in curve.index[curve.isna()]:
        ax.plot(step, 0, "x", color=style.FAILED, markersize=5, clip_on=False, zorder=5)
    peak = curve.idxmax()
    ax.annotate("▼", (peak, curve[peak]), (0, 2),
                textcoords="offset points",
                ha="center",
                va="bottom",
                fontsize=8,
                annotation_clip=False)
    ax.set_title(f"{PARTITIONER} + {refiner}")
    ax.set_title(
        f"median {style.short(curve.median())} ms, peak {style.short(curve[peak])} ms at step {peak:.0f}",
        loc="right",
        fontweight="normal",
        fontsize=8.5)
    ax.set_ylabel("$t_s$, ms")
