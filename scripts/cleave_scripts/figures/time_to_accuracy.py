"""Time against the residual asked for, a panel a problem, and how often each solver is how near to the fastest."""
import math

from cleave_scripts.figures import looks, style
from cleave_scripts.measurements.accuracy import EXACT, LIMITS, failures, profile
from cleave_scripts.table import text

PROFILED = (1e-2, 1e-4, 1e-6, 1e-8)
WIDEST = 1000  # times the fastest, where a profile ends
SPECIAL = {EXACT: {"color": looks.WHOLE_SYSTEM, "linewidth": 2.2, "zorder": 4}}


def _methods(found):
    marks = looks.marks(dict.fromkeys(method for problem in found for method in problem.times_ms))
    return {method: {"linewidth": 0.9, **look, **SPECIAL.get(method, {})} for method, look in marks.items()}


def _power(axis):
    axis.set_major_formatter(style.matplotlib.ticker.FuncFormatter(lambda value, _: text.power(value)))


def draw_times(found):
    figure, axes = style.panels(len(found), 3, 2.0, sharex=True)
    looked = _methods(found)
    for ax, problem in zip(axes, found):
        for method, times in problem.times_ms.items():
            reached = [limit for limit in LIMITS if not math.isinf(times[limit])]
            ax.plot(reached, [times[limit] for limit in reached],
                    **looked[method], markersize=2.6)
        scene, bodies, cfm, _ = problem.key
        ax.set_title(f"{scene.replace('_', ' ')}, {bodies} bodies\n{problem.rows} rows, cfm {float(cfm):g}", fontsize=7.5)
        ax.set(xscale="log", yscale="log", xlabel="residual, m/s", ylabel="$t_{pr} + t_s$, ms")
        ax.set_xlim(2 * LIMITS[0], LIMITS[-1] / 2)
        ax.set_xticks(LIMITS[::2])
        _power(ax.xaxis)
        ax.xaxis.set_minor_locator(style.matplotlib.ticker.NullLocator())
        ax.yaxis.set_major_formatter(style.matplotlib.ticker.FuncFormatter(lambda value, _: style.short(value)))
    style.legend_above(figure, _lines(looked), columns=4)
    return figure


def _lines(looked, texts=None):
    return [style.matplotlib.lines.Line2D([], [], **look, markersize=4, label=(texts or {}).get(method, method))
            for method, look in looked.items()]


def draw_profiles(found):
    figure, axes = style.panels(len(PROFILED), 2, 2.3, sharex=True)
    looked = _methods(found)
    failed = {method: [] for method in looked}
    for ax, limit in zip(axes, PROFILED):
        for method, ratios in profile(found, limit).items():
            failed[method].append(f"{failures(ratios)}")
            inside = [ratio for ratio in ratios if ratio <= WIDEST]
            shares = [(place + 1) / len(ratios) for place in range(len(inside))]
            ax.step([1, *inside, WIDEST], [0, *shares, max(shares, default=0)], where="post", color=looked[method]["color"],
                    linewidth=looked[method]["linewidth"])
        ax.set(xscale="log", xlabel="times the fastest", ylabel="share of the problems", ylim=(-0.03, 1.03))
        ax.set_title(f"residual {text.power(limit)} m/s")
    texts = {method: f"{method} (never: {'/'.join(counts)})" for method, counts in failed.items()}
    style.legend_above(figure, _lines(looked, texts), columns=2)
    return figure
