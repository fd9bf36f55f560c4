"""Figure 5 of the paper: t_s of every measured step on Log Tower, mindp with each refiner, peaks marked."""
from figures import style
from figures.choose import first_runs, provenance, title
from figures.tree import NoData, need

SCENE, PARTITIONER = "log_tower", "mindp"


def draw(data):
    if SCENE not in data.main:
        raise NoData(f"no rows of scene {SCENE}")
    measured = first_runs(data.main[SCENE])
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
    axes.flat[0].set_ylim(0, 1.08 * max(curve.max() for curve in curves.values()) or 1)
    axes.flat[-1].set_xlabel("step")
    failed = " Crosses: steps without a row that is ok." if any(
        curve.isna().any() for curve in curves.values()) else ""
    return figure, (
        f"Time t_s of each measured step of {title(SCENE)}, partitioner {PARTITIONER} with each refiner. "
        f"Triangles mark the highest peak, the grey area is {PARTITIONER} + {refiners[0]} again.{failed} " +
        provenance({title(SCENE): data.main[SCENE]}))


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
    ax.plot(peak, curve[peak], "v", color=style.INK, markersize=6, clip_on=False, zorder=5)
    ax.set_title(f"{PARTITIONER} + {refiner}")
    ax.set_title(
        f"median {style.short(curve.median())} ms, peak {style.short(curve[peak])} ms at step {peak:.0f}",
        loc="right",
        fontweight="normal",
        fontsize=8.5)
    ax.set_ylabel("$t_s$, ms")
