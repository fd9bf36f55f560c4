"""Time against the residual asked for, a panel a problem; where the exact solver overtakes the others; and how often each
solver is how near to the fastest."""
import math

from cleave_scripts.figures import looks, style
from cleave_scripts.figures.tree import NoData
from cleave_scripts.measurements import crossover
from cleave_scripts.measurements.accuracy import EXACT, LIMITS, failures, profile, refusals, threads_in_words
from cleave_scripts.table import text

PROFILED = (1e-2, 1e-4, 1e-6, 1e-8)
TIME = "$t_{pr} + t_s$, ms"
WIDEST = 1000  # times the fastest, where a profile ends
SPECIAL = {EXACT: {"color": looks.WHOLE_SYSTEM, "linewidth": 2.2, "zorder": 4}}


def methods(found):
    """{method: keyword arguments of its line}"""
    marks = looks.marks(dict.fromkeys(method for problem in found for method in problem.times_ms))
    return {method: {"linewidth": 0.9, "linestyle": looks.LINES[place // len(looks.CYCLE)], **look, **SPECIAL.get(method, {})}
            for place, (method, look) in enumerate(marks.items())}


def measured(data):
    if data.tree.accuracy is None:
        raise NoData("no tradeoff.csv with rows; scripts/tradeoff writes one")
    return data.tree.accuracy


def times(data):
    """Figure of the report, with its caption."""
    found = measured(data)
    return draw_times(found), (
        f"Recorded steps, soft and stiff, {threads_in_words(found[0].threads)}. A solver that iterates was told to stop at "
        "each residual (divided by the largest free velocity where that is above 1 m/s) and is drawn as far as it got; what "
        "factors has one time for all residuals that it reaches.")


def crossovers(data):
    return draw_crossover(measured(data)), (
        f"Rock piles of which one thing changes: t_pr + t_s of the fastest solver that iterates over that of {EXACT}, by the "
        f"residual it was told to stop at. Above 1 {EXACT} is faster; a point at the upper edge stands for never.")


def profiles(data):
    return draw_profiles(measured(data)), (
        "Share of the recorded steps that a solver takes to a residual in so many times the time of the fastest (Dolan and "
        "More, Mathematical Programming 91, 2002). In the legend: on how many steps it never got to 1e-2, 1e-4, 1e-6 and 1e-8 "
        "m/s, and how many it refused, as they have more rows than it takes; in the curves these count as steps on which it "
        "never got there.")


def draw_times(found):
    found = [problem for problem in found if problem.is_drawn]
    figure, axes = style.panels(len(found), 3, 2.0, sharex=True)
    looked = methods(found)
    for ax, problem in zip(axes, found):
        for method, times in problem.times_ms.items():
            reached = [limit for limit in LIMITS if not math.isinf(times[limit])]
            ax.plot(reached, [times[limit] for limit in reached],
                    **looked[method], markersize=2.6)
        ax.set_title(f"{problem.place}\n{problem.rows} rows, cfm {problem.cfm:g}{', settled' if problem.is_settled else ''}",
                     fontsize=7.5)
        ax.set(xlabel="residual, m/s", ylabel=TIME)
        scale(ax)
    style.legend_above(figure, legend_lines(looked), columns=4)
    return figure


def scale(ax):
    """Residuals from the largest on down, in powers of ten, against times."""
    ax.set(xscale="log", yscale="log")
    ax.set_xlim(2 * LIMITS[0], LIMITS[-1] / 2)
    ax.set_xticks(LIMITS[::2])
    ax.xaxis.set_major_formatter(style.matplotlib.ticker.FuncFormatter(lambda value, _: text.power(value)))
    ax.xaxis.set_minor_locator(style.matplotlib.ticker.NullLocator())
    ax.yaxis.set_major_formatter(style.matplotlib.ticker.FuncFormatter(lambda value, _: style.short(value)))


def draw_crossover(found):
    """The fastest solver that iterates as a multiple of exact, a panel an axis and a line a limit;
    at the upper edge where none got there."""
    figure, axes = style.panels(len(crossover.AXES), 3, 2.6, sharey=True)
    colours = looks.shades(len(crossover.LIMITS))
    points = {axis: axis.problems(found) for axis in crossover.AXES}
    ratios = [problem.against_exact(limit) for on_axis in points.values() for problem in on_axis for limit in crossover.LIMITS]
    top = 2 * max((ratio for ratio in ratios if not math.isinf(ratio)), default=1)
    for ax, axis in zip(axes, crossover.AXES):
        ax.set_title(axis.title, fontsize=7.5)
        ax.set_xlabel(axis.label)
        if not points[axis]:
            continue  # nothing that a logarithm could be taken of
        for limit, colour in zip(crossover.LIMITS, colours):
            ax.plot([axis.of(problem) for problem in points[axis]],
                    [min(problem.against_exact(limit), top) for problem in points[axis]], color=colour,
                    marker="o", markersize=3)
        ax.axhline(1, color=style.INK, linewidth=0.8)
        ax.set(xscale="log", yscale="log")
        if axis.of(points[axis][-1]) < 100 * axis.of(points[axis][0]):  # hardly a power of ten in it: the points themselves
            ax.set_xticks([axis.of(problem) for problem in points[axis]])
            ax.xaxis.set_minor_locator(style.matplotlib.ticker.NullLocator())
            ax.xaxis.set_major_formatter(style.matplotlib.ticker.FuncFormatter(lambda value, _: style.short(value)))
    axes[0].set_ylabel(f"fastest that iterates over exact,\n{TIME.removesuffix(', ms')} (above 1 exact is faster)")
    style.legend_above(figure, [style.matplotlib.lines.Line2D([], [], color=colour, marker="o", markersize=3,
                                                              label=f"to {text.power(limit)} m/s")
                                for limit, colour in zip(crossover.LIMITS, colours)], columns=len(colours))
    return figure


def legend_lines(looked, texts=None):
    return [style.matplotlib.lines.Line2D([], [], **{"markersize": 4, **look}, label=(texts or {}).get(method, method))
            for method, look in looked.items()]


def draw_profiles(found):
    figure, axes = style.panels(len(PROFILED), 2, 2.3, sharex=True)
    looked = methods(found)
    for ax, limit in zip(axes, PROFILED):
        for method, ratios in profile(found, limit).items():
            inside = [ratio for ratio in ratios if ratio <= WIDEST]
            shares = [(place + 1) / len(ratios) for place in range(len(inside))]
            ax.step([1, *inside, WIDEST], [0, *shares, max(shares, default=0)], where="post",
                    **{name: looked[method][name] for name in ("color", "linewidth", "linestyle")})
        ax.set(xscale="log", xlabel="times the fastest", ylabel="share of the problems", ylim=(-0.03, 1.03))
        ax.set_title(f"residual {text.power(limit)} m/s")
    style.legend_above(figure, legend_lines(looked, {method: f"{method} ({_left_out(found, method)})" for method in looked}),
                       columns=2)
    return figure


def _left_out(found, method):
    """How often it never got there, and how often it did not try."""
    refused = refusals(found, method)
    return (f"never: {'/'.join(str(failures(found, method, limit)) for limit in PROFILED)}" +
            (f"; refused: {refused}" if refused else ""))
