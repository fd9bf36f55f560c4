"""The picture of what accuracy costs: time to a residual on six recorded steps, by every solver."""
import math

from cleave_scripts.figures import looks, style
from cleave_scripts.figures.time_to_accuracy import SPECIAL, TIME, legend_lines, measured, scale
from cleave_scripts.figures.tree import NoData
from cleave_scripts.measurements.accuracy import EXACT, LIMITS, threads_in_words
from cleave_scripts.results.names import base_name, title
from cleave_scripts.table import text

# Scene, bodies and cfm of each panel; the first of several steps counts.
PANELS = (("rock_pile", 200, 1e-4), ("rock_pile", 200, 1e-8), ("large_rock_pile", 600, 1e-6), ("log_tower", 201, 1e-6),
          ("chain_drop", 100, 1e-6), ("crane", 124, 1e-10))
COLUMNS = 3
# Those that are told apart best, as thin lines, first.
COLOURS = tuple(looks.CYCLE[place] for place in (0, 1, 2, 4, 9, 5, 10, 6, 3, 7))
NAME_SIZE = 6.5
NAME_HEIGHT = 0.075  # of a panel, of a name beside it


def price(data):
    """Figure of the report, with its caption."""
    found = measured(data)
    return draw_price(found), (
        f"Six recorded steps, {threads_in_words(found[0].threads)}. What factors or pivots has one time for all residuals and "
        "is named at the right, also where it refused the step, as it has more rows than that takes, or failed; a solver that "
        "iterates was told to stop at each residual (divided by the largest free velocity where that is above 1 m/s) and is "
        "drawn as far as it got.")


def shown(found):
    """The problems that are drawn, in their order."""
    first = {}
    for problem in found:
        first.setdefault((problem.scene, problem.bodies, problem.cfm), problem)
    return [first[panel] for panel in PANELS if panel in first]


def draw_price(found):
    picked = shown(found)
    if not picked:
        raise NoData("none of the steps that are drawn was measured")
    figure, axes = style.panels(len(picked), COLUMNS, 2.35)
    looked = _looks(picked)
    for ax, problem in zip(axes, picked):
        ax.set_title(f"{title(problem.scene)}, cfm {text.power(problem.cfm)}\n{problem.bodies} bodies, {problem.rows} rows",
                     fontsize=8)
        scale(ax)
        for method, look in looked.items():
            _curve(ax, problem.times_ms[method], look)
        _direct(ax, problem)
    for ax in axes[::COLUMNS]:
        ax.set_ylabel(TIME)
    for ax in axes[-COLUMNS:]:
        ax.set_xlabel("residual, m/s")
    style.legend_above(figure, legend_lines(looked), columns=4)
    return figure


def _looks(picked):
    """{method that iterates: keyword arguments of its line}: a colour an algorithm, a line an order of its rows."""
    methods = dict.fromkeys(method for problem in picked for method in problem.iterative)
    found, lines = {}, {}
    for place, method in enumerate(methods):
        base = base_name(method)
        lines[base] = lines.get(base, -1) + 1
        found[method] = {"color": looks.readable(COLOURS[list(lines).index(base) % len(COLOURS)]), "linewidth": 1.2,
                         "linestyle": looks.LINES[lines[base] % len(looks.LINES)],
                         "marker": looks.MARKERS[place % len(looks.MARKERS)]}
    return found


def _curve(ax, times, look):
    reached = [limit for limit in LIMITS if not math.isinf(times[limit])]
    ax.plot(reached, [times[limit] for limit in reached], **look, markersize=3)


def _name(method):
    """'interior-point' of 'interior-point:monolithic', 'schur' of 'schur, mix+fm'."""
    return base_name(method).partition(":")[0].partition(",")[0]


def _direct(ax, problem):
    """A line a solver that has one time, with its name beside the panel; at the bottom those without, and why."""
    times_ms = {method: times[LIMITS[-1]] for method, times in problem.times_ms.items() if method not in problem.iterative}
    there = sorted((time, method) for method, time in times_ms.items() if not math.isinf(time))
    for time, method in there:
        ax.axhline(time, **SPECIAL.get(method, {"color": style.MUTED, "linewidth": 1.2}))
    low, high = map(math.log, ax.get_ylim())
    notes = _without(problem, [method for method, time in times_ms.items() if math.isinf(time)])
    heights = apart([NAME_HEIGHT * place for place in range(len(notes))] +
                    [max((math.log(time) - low) / (high - low), NAME_HEIGHT * len(notes)) for time, _ in there], NAME_HEIGHT)
    names = [(note, {"color": style.FAILED}) for note in reversed(notes)]
    names += [(_name(method), {"color": style.INK, "fontweight": "bold" if method == EXACT else "normal"})
              for _, method in there]
    for height, (name, look) in zip(heights, names):
        ax.text(1.02, height, name, transform=ax.transAxes, va="center", fontsize=NAME_SIZE, **look)


def _without(problem, methods):
    """Lines that name those without a time."""
    refused = [_name(method) for method in methods if method in problem.refused]
    failed = [_name(method) for method in methods if method not in problem.refused]
    return [line for word, names in (("refused:", refused), ("failed:", failed)) if names for line in (word, *names)]


def apart(heights, least):
    """Ascending heights moved as little as they need to be to stand so far from each other."""
    groups = []
    for height in heights:
        groups.append([height])
        while len(groups) > 1 and _bottom(groups[-1], least) < _bottom(groups[-2], least) + least * len(groups[-2]):
            groups[-2:] = [groups[-2] + groups[-1]]
    return [_bottom(group, least) + least * place for group in groups for place in range(len(group))]


def _bottom(group, least):
    """Where the lowest of these stands once they are put close above each other about their middle."""
    return sum(group) / len(group) - least * (len(group) - 1) / 2
