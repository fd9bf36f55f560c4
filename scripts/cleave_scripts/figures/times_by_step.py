"""Figure 5 of the paper: t_s of every measured step on Log Tower, one partitioner with each refiner, peaks marked."""
from cleave_scripts.figures import looks, style
from cleave_scripts.figures.choose import merged_runs, most_steps, provenance
from cleave_scripts.figures.tree import need
from cleave_scripts.results.names import title
from cleave_scripts.results.paper import PAPER

SCENE = PAPER["figure5"]["scene"]


def longest_runs(data):
    """The blocks of the run that measured most steps; more than one where it was repeated."""
    return most_steps(data.blocks, SCENE, data.solver, _partitioner(data))


def _partitioner(data):
    """The paper's; where it was not run on the scene, the first that was."""
    parts = [part for block in data.blocks if block.scene == SCENE and (part := block.of_solver(data.solver)) is not None]
    names = looks.partitioners_in(name for part in parts for name in part.rows["partitioner"])
    of_paper = PAPER["figure5"]["partitioner"]
    return of_paper if of_paper in names or not names else names[0]


def draw(data):
    blocks, partitioner = longest_runs(data), _partitioner(data)
    measured = merged_runs(blocks)
    measured = measured[measured["partitioner"] == partitioner]
    rows = need(measured[measured["status"] == "ok"], "step", "t_s_ms")
    refiners = looks.refiners_in(rows["refiner"])
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
        _curve(ax, partitioner, refiner, curve)
    axes.flat[0].set_ylim(0, 1.15 * max(curve.max() for curve in curves.values()) or 1)
    axes.flat[-1].set(xlabel="step", xlim=(min(0, steps[0]), steps[-1] + 1))
    failed = " Crosses: steps without a row that is ok." if any(
        curve.isna().any() for curve in curves.values()) else ""
    return figure, (
        f"Time t_s of each measured step of {title(SCENE)}, partitioner {partitioner} with each refiner. "
        f"Triangles mark the highest peak, the grey area is {partitioner} + {refiners[0]} again.{failed} " +
        provenance({title(SCENE): blocks}))


def _curve(ax, partitioner, refiner, curve):
    look = looks.line_look(partitioner, refiner)
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
    ax.set_title(f"{partitioner} + {refiner}")
    ax.set_title(
        f"median {style.short(curve.median())} ms, peak {style.short(curve[peak])} ms at step {peak:.0f}",
        loc="right",
        fontweight="normal",
        fontsize=8.5)
    ax.set_ylabel("$t_s$, ms")
