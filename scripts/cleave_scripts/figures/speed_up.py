"""Modelled speed-up for 1 to 64 workers, beside what runs with more threads measured."""
import re

import pandas

from cleave_scripts.figures import looks, style
from cleave_scripts.figures.choose import machines, preference
from cleave_scripts.figures.tree import NoData
from cleave_scripts.results.names import NO_PARTITIONER, title

MODEL = re.compile(r"t_s_model_p(\d+)_ms")
SPREAD = 1.35  # ratio of the places of the last and the first mark of as many workers
IDEAL = {"color": "#BBBBBB", "linewidth": 3, "zorder": 1}
KEYS = ["seed", "step", "partitioner", "refiner"]


def draw(data):
    groups = [group for group in _groups(data) if group[1] is not None]
    if not groups:
        raise NoData("no one-thread run with columns t_s_model_p<N>_ms")
    figure, axes = style.panels(len(groups), 2, 2.6, sharey=True)
    measured, shares = False, []
    for ax, (name, base, others) in zip(axes, groups):
        _model(ax, base.ok)
        drawn, found = _measured(ax, base, others)
        measured |= drawn
        shares += found
        ax.set_title(name)
    _limits(axes)
    rows = pandas.concat([base.ok for _, base, _ in groups])
    names, refiners = looks.partitioners_in(rows["partitioner"]), looks.refiners_in(rows["refiner"])
    lines = [
        style.matplotlib.lines.Line2D([], [], **looks.line_look(NO_PARTITIONER, name), label=name) for name in refiners
    ]
    lines.append(style.matplotlib.lines.Line2D([], [], **IDEAL, label="ideal"))
    style.legend_above(figure, [*style.partitioner_patches(names), *lines], columns=len(names) + len(lines))
    said = ("Marks with a black edge: measured, t_s with one thread over t_s with that many on the same "
            "steps, spread sideways." if measured else
            "No data: no run with more threads of the same setup, so nothing measured stands beside.")
    check = (f" There, the modelled time of a combination with as many workers is {min(shares):.2f} to "
             f"{max(shares):.2f} of the measured." if shares else "")
    parts = [part for _, base, others in groups for part in [base, *others]]
    charged = all("dispatch" in base.experiment.manifest.get("machine", {}) for _, base, _ in groups)
    charge = ", each charged what it costs to hand out an empty one" if charged else ""
    return figure, (
        "Speed-up of the solve against the number of workers, as ratio of mean t_s. Curves: modelled from "
        "the task times of one-thread runs (every parallel stage takes the makespan of its tasks, longest "
        f"first{charge}; communication is left out). {said}{check} {machines(parts)}")


def _limits(axes):
    """Room for every mark with its rim; the ideal line may go out of the picture.

    Both axes are logarithmic, so that it is straight.
    """
    heights = [height for ax in axes for line in ax.lines if line.get_gid() != "ideal"
               for height in line.get_ydata() if height > 0]
    room = max(1.3, (max(heights) / min(heights))**0.12)
    axes[0].set_ylim(min(heights) / room, max(heights) * room)
    for axis in [ax.yaxis for ax in axes]:
        axis.set_major_locator(style.matplotlib.ticker.LogLocator(subs=(1, 1.5, 2, 3, 5, 7)))
        axis.set_major_formatter(style.matplotlib.ticker.FuncFormatter(lambda value, _: style.short(value)))
        axis.set_minor_locator(style.matplotlib.ticker.NullLocator())


def _groups(data):
    """[(name, one-thread block or None, blocks with more threads)] of the scenes of the paper's figures."""
    for scene, main in data.main.items():
        same = [
            part for block in data.blocks if block.setup == main[0].setup and block.scene == scene and
            (part := block.of_solver(data.solver)) is not None and part.label == main[0].label
        ]
        same.sort(key=preference)
        base = [part for part in same if part.threads == 1 and model_columns(part.ok)]
        others = {}
        for part in same:
            if (part.threads or 1) > 1:
                others.setdefault(part.threads, part)
        yield title(scene), base[0] if base else None, list(others.values())


def model_columns(rows):
    """{workers: column} of the columns that hold times."""
    found = {int(match.group(1)): match.group(0) for match in map(MODEL.fullmatch, rows.columns) if match}
    found = {workers: column for workers, column in sorted(found.items()) if rows[column].gt(0).any()}
    return found if 1 in found else {}


def _model(ax, rows):
    columns = model_columns(rows)
    ax.plot([1, max(columns)], [1, max(columns)], **IDEAL, gid="ideal")
    for (partitioner, refiner), part in rows.groupby(["partitioner", "refiner"]):
        means = part[list(columns.values())].mean()
        look = looks.line_look(partitioner, refiner)
        ax.plot(list(columns), means[columns[1]] / means, **look, markersize=3, linewidth=1)
    ax.set(xscale="log", yscale="log", xlabel="workers", ylabel="speed-up of $t_s$")
    ax.set_xticks(list(columns), list(map(str, columns)))
    ax.xaxis.set_minor_locator(style.matplotlib.ticker.NullLocator())


def _measured(ax, base, others):
    """Draws the marks; returns (whether there are any, modelled over measured times of as many workers)."""
    keys = [key for key in KEYS if key in base.rows]
    drawn, shares = False, []
    for other in others:
        both = base.ok.merge(other.ok, on=keys, suffixes=("_1", "_n"))
        combinations = list(both.groupby(["partitioner", "refiner"]))
        for index, ((partitioner, refiner), part) in enumerate(combinations):
            look = looks.line_look(partitioner, refiner)
            # Side by side, as many would lie on top of each other.
            shift = SPREAD**(index / max(len(combinations) - 1, 1) - 0.5)
            ax.plot(other.threads * shift,
                    part["t_s_ms_1"].mean() / part["t_s_ms_n"].mean(),
                    look["marker"],
                    markersize=5,
                    color=look["color"],
                    markeredgecolor=style.INK,
                    markeredgewidth=0.6,
                    zorder=5)
            drawn = True
            modelled = _modelled_with(part, other.threads)
            if modelled is not None:
                shares.append(modelled / part["t_s_ms_n"].mean())
    return drawn, shares


def _modelled_with(part, workers):
    """Mean modelled time of a one-thread run joined with another; None where the model lacks that number."""
    name = f"t_s_model_p{workers}_ms"
    values = next((part[column] for column in (f"{name}_1", name) if column in part), None)
    return values.mean() if values is not None and values.gt(0).any() else None
