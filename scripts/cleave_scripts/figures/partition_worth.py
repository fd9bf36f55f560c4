"""Speed-up against workers, each kernel with the best partition that cuts, and the whole system, from round to round;
a panel a problem."""
from cleave_scripts.figures import looks, style
from cleave_scripts.measurements.partition_worth import NAMES, WORKERS

IDEAL = {"color": "#BBBBBB", "linewidth": 3, "zorder": 1}
ROUNDS = {"alpha": 0.15, "linewidth": 0}  # what lies between the rounds
APART = 1.13  # from one measured mark to the next, which would hide each other at 2 workers


def draw(problems):
    figure, axes = style.panels(len(problems), 3, 2.0, sharex=True)
    marks = looks.marks(NAMES)
    for ax, problem in zip(axes, problems):
        ax.plot(WORKERS, WORKERS, **IDEAL)
        for number, (solver, look) in enumerate(marks.items()):
            if solver not in problem.best[1]:
                continue
            cells = [problem.best[workers][solver] for workers in WORKERS]
            ax.plot(WORKERS, list(map(problem.speed_up, cells)), **look, markersize=3, linewidth=1)
            ax.fill_between(WORKERS, *zip(*map(problem.speed_ups, cells)), color=look["color"], **ROUNDS)
            if solver in problem.measured:
                place, cell = 2 * APART ** (number - (len(marks) - 1) / 2), problem.measured[solver]
                ax.plot([place] * 2, problem.speed_ups(cell), color=look["color"], linewidth=1, zorder=4)
                ax.plot(place, problem.speed_up(cell), color=look["color"], marker=look["marker"], markersize=5.5,
                        markeredgecolor=style.INK, markeredgewidth=0.7, zorder=5)
        scene, bodies, cfm = problem.key
        ax.set_title(f"{scene.replace('_', ' ')}, {bodies} bodies\n{problem.rows} rows, cfm {float(cfm):g}", fontsize=7.5)
        ax.set(xscale="log", yscale="log", xlabel="workers", ylabel="speed-up")
        ax.set_xticks(WORKERS, list(map(str, WORKERS)))
        ax.set_ylim(0.5, 10)
        ax.set_yticks([0.5, 1, 2, 4, 8])
        ax.yaxis.set_minor_locator(style.matplotlib.ticker.NullLocator())
        ax.xaxis.set_minor_locator(style.matplotlib.ticker.NullLocator())
        ax.yaxis.set_major_formatter(style.matplotlib.ticker.FuncFormatter(lambda value, _: style.short(value)))
    lines = [style.matplotlib.lines.Line2D([], [], **look, markersize=4, label=NAMES[solver]) for solver, look in marks.items()]
    style.legend_above(figure, [*lines, style.matplotlib.lines.Line2D([], [], **IDEAL, label="ideal")], columns=5)
    return figure
