"""Speed against accuracy: time to a residual, what a motion becomes, which parts solvers that iterate want,
and what leaving rows out saves."""
import math
import statistics

from cleave_scripts.documents.stored import NoResults, need
from cleave_scripts.measurements import model_savings as savings_of
from cleave_scripts.measurements import partitions_of_solvers as parts_of
from cleave_scripts.measurements.accuracy import (ASKED_AT_ROWS, ASKED_OF_ODE_STEP, ASKED_OF_PGS, ASKED_OF_SWEEPS, AT_LIMIT,
                                                  EXACT, LEAST_SWEEPS, ODE_STEP, TIMES_AS_FAST, asked_of_a_sweep, problems,
                                                  settled_piles, sweep_costs, threads_in_words, threads_of)
from cleave_scripts.measurements.crossover import AXES, LIMITS as CROSSED, exact_is_faster
from cleave_scripts.measurements.motion_of_solvers import EXACT_AS_WELL, OF_FEW_ROWS, motions
from cleave_scripts.table import text

COMMAND = "scripts/tradeoff"
TIMES, MOTION, PARTS = (("tradeoff.csv", COMMAND), ("tradeoff_motion.csv", COMMAND), ("tradeoff_partitions.csv", COMMAND))
MODEL = ("model_savings.csv", "scripts/model_savings")
SHOWN = (1e-2, 1e-4, 1e-6, 1e-8)


def _against(problem, limit):
    """The fastest solver that iterates, as a multiple of exact."""
    method, time_ms = problem.fastest(limit, problem.iterative)
    if math.isinf(time_ms):
        return "never"
    return f"{text.number(problem.against_exact(limit))} ({method})"


def _ten_times(found):
    """On what exact is so many times as fast, place by place, and by how much."""
    holds, fails = {}, {}
    for problem in found:
        ratio = problem.against_exact(AT_LIMIT)
        told = f"{problem.case}: {'never' if math.isinf(ratio) else text.number(ratio)}"
        (holds if ratio >= TIMES_AS_FAST else fails).setdefault(problem.place, []).append(told)
    on, not_on = ("; ".join(f"{place} ({'; '.join(cases)})" for place, cases in of.items()) or "none" for of in (holds, fails))
    fast = sum(map(len, holds.values()))
    return (f"`{EXACT}` is at least {TIMES_AS_FAST} times as fast as the fastest solver that iterates to "
            f"{text.power(AT_LIMIT)} on {fast} of these {len(found)} steps: {on}. Not on {len(found) - fast}: {not_on}.")


def time_to_accuracy(stored):
    rows = need(stored.table(*TIMES), "time to accuracy", "status")
    found, lines = problems(rows), []
    for problem in found:
        crossover = problem.crossover()
        lines.append([problem.title, text.number(problem.time_ms(EXACT, SHOWN[-1])),
                      *(_against(problem, limit) for limit in SHOWN), text.power(crossover) if crossover else "none"])
    return (f"t_s of `{EXACT}`, ms, {threads_in_words(threads_of(rows))}, on recorded steps; then t_pr + t_s of the fastest "
            "of the solvers that iterate, told to stop at a residual (m/s over max(1, largest free velocity)), as a multiple "
            "of that: below 1 it is faster, *never* means that none got there in the sweeps it was given; last the largest "
            f"residual from which on down `{EXACT}` is faster than all of them (`{COMMAND}`; {stored.origin(TIMES[0])}):\n\n" +
            text.table(["", f"`{EXACT}`, ms", *map(text.power, SHOWN), "`exact` faster from"], lines) +
            f"\n\n{_ten_times(found)}")


def _holds(holds):
    return "holds" if holds else "does not hold"


def ode_step(stored):
    """ODE's own direct stepper against exact, on piles at rest."""
    piles = settled_piles(problems(need(stored.table(*TIMES), "time to accuracy", "status")))
    if not piles:
        raise NoResults(f"Not stored yet, `results/{TIMES[0]}` has no settled piles: `{COMMAND}` makes it anew.")
    asked = min(piles, key=lambda pile: abs(pile.rows - ASKED_AT_ROWS))
    lines = [[pile.title, text.number(pile.kinetic_energy_j), text.number(pile.time_ms(EXACT, SHOWN[-1])),
              *_of_ode_step(pile, pile is asked)] for pile in piles]
    return (f"Settled rock piles, {threads_in_words(piles[0].threads)}: t_s of `{EXACT}` and of `{ODE_STEP}`, ODE's "
            f"`dWorldStep`, of the same step. Asked: `{ODE_STEP}` takes at least {ASKED_OF_ODE_STEP} times as long on a "
            f"settled step of about {ASKED_AT_ROWS} rows (`{COMMAND}`; {stored.origin(TIMES[0])}):\n\n" +
            text.table(["", "kinetic energy, J", f"`{EXACT}`, ms", f"`{ODE_STEP}`, ms", f"`{ODE_STEP}` over `{EXACT}`",
                        "asked"], lines))


def _of_ode_step(pile, is_asked):
    if ODE_STEP in pile.refused:
        return "refused", "-", "-"
    time_ms = pile.time_ms(ODE_STEP, SHOWN[-1])
    if math.isinf(time_ms):
        return "failed", "-", "-"
    ratio = time_ms / pile.time_ms(EXACT, SHOWN[-1])
    return text.number(time_ms), text.number(ratio), _holds(ratio >= ASKED_OF_ODE_STEP) if is_asked else "-"


def _ranges(axis, problems_on_axis, limit):
    """Where exact is faster, in words."""
    found = exact_is_faster([(axis.of(problem), problem.against_exact(limit)) for problem in problems_on_axis])
    said = []
    for start, end in found:
        if start is None and end is None:
            return "all"
        said.append(f"from {text.number(start)}" if end is None else
                    f"to {text.number(end)}" if start is None else f"{text.number(start)} to {text.number(end)}")
    return ", ".join(said) or "none"


def crossover(stored):
    """Where along an axis exact overtakes what iterates."""
    found = problems(need(stored.table(*TIMES), "crossovers", "series"))
    lines = []
    for axis in AXES:
        on_axis = axis.problems(found)
        span = f"{text.number(axis.of(on_axis[0]))} to {text.number(axis.of(on_axis[-1]))}"
        lines.append([f"{axis.label}, {span} ({axis.title})", *(_ranges(axis, on_axis, limit) for limit in CROSSED)])
    return (f"Where `{EXACT}` is faster than every solver that iterates, on rock piles of which one thing changes, by the "
            f"residual those were told to stop at; between measured values by straight lines in logarithms (`{COMMAND}`; "
            f"{stored.origin(TIMES[0])}):\n\n" + text.table(["", *map(text.power, CROSSED)], lines))


def sweep_cost(stored):
    """What a sweep costs each solver that iterates, and whether it keeps its limit."""
    rows = need(stored.table(*TIMES), "solvers that iterate", "iterations")
    found = sweep_costs(rows)
    keeps = {solver: statistics.median(costs) <= asked_of_a_sweep(solver) for solver, costs in found.items()}
    lines = [[f"`{solver}`", len(costs), *(text.number(cost) for cost in (statistics.median(costs), min(costs), max(costs))),
              asked_of_a_sweep(solver), _holds(keeps[solver])] for solver, costs in found.items()]
    missed = [f"`{solver}`" for solver in keeps if not keeps[solver]]
    kept = f"Kept by all but {text.listed(missed)}." if missed else "Kept by all."
    return (f"ns a row and sweep or iteration, {threads_in_words(threads_of(rows))}, of the solves of at least {LEAST_SWEEPS} "
            f"sweeps, looks at the residual and preparation included (`{COMMAND}`; {stored.origin(TIMES[0])}). Asked, of the "
            f"median: at most {ASKED_OF_PGS} of `pgs` in its natural order, at most {ASKED_OF_SWEEPS} of every other solver "
            "that iterates:\n\n" + text.table(["", "solves", "median", "least", "most", "asked", ""], lines) + f"\n\n{kept}")


def motion(stored):
    found = motions(need(stored.table(*MOTION), "motions", "mover"))
    lines = [[of.title, of.mover, text.number(of.mean_ms), text.number(float(of.last["residual_m_per_s"])),
              text.number(1000 * float(of.last["max_penetration_m"])), text.number(1000 * float(of.last["joint_drift_m"])),
              text.number(float(of.last["height_m"])), text.number(float(of.last["kinetic_energy_j"]) / 1000),
              text.number(float(of.last["potential_energy_j"]) / 1000)] for of in found]
    return (f"Scenes that one solver alone has moved, at the end (`{COMMAND}`; {stored.origin(MOTION[0])}). t_s is the mean of "
            "the measured steps, of one substep where a step has several; height is that of the highest centre:\n\n" +
            text.table(["scene", "moved by", "t_s, ms", "residual, m/s", "penetration, mm", "joint drift, mm", "height, m",
                        "kinetic energy, kJ", "potential energy, kJ"], lines) + _of_small(found))


def _of_small(found):
    """Why some solvers move one scene alone, and how far from exact they moved it."""
    exact_too = [mover.name for mover in (*EXACT_AS_WELL, *OF_FEW_ROWS)]
    alone = [of for of in found if of.mover in exact_too]
    if not alone:
        return ""  # a file of an earlier commit
    exact = next(of for of in found if of.place == alone[0].place and of.mover == EXACT)
    apart_m = max(abs(float(of.last["height_m"]) - float(exact.last["height_m"])) for of in alone)
    few, others = (text.listed(f"`{mover.name}`" for mover in movers) for movers in (OF_FEW_ROWS, EXACT_AS_WELL))
    return (f"\n\n{few} refuse steps of as many rows as the other scenes have, and {others} solve to the same residual as "
            f"`{EXACT}`: these move {exact.title}, alone. There the height at the end differs from that under `{EXACT}` by at "
            f"most {text.number(1000 * apart_m)} mm.")


def _parts_cell(column, ratios):
    time, sweeps = ratios
    if math.isinf(time):
        return "never"
    return text.number(time) + (f" ({text.number(sweeps)})" if parts_of.iterates(column) else "")


def _column_title(column):
    solver, threads = column
    return f"`{solver}`" + (f", {threads} threads" if threads not in ("", "1") else "")


def _which_partition(compared):
    """Which is best for whom, what one part costs, and what costs the others that which is best for the first direct solver."""
    best = {column: parts_of.best_parts(of) for column, of in compared.items()}
    told = [f"for {_column_title(column)} `{'+'.join(best[column])}` ({text.number(of[best[column]][0])}; one part "
            f"{_parts_time(of, parts_of.ONE_PART)})" for column, of in compared.items()]
    direct = next(column for column in compared if not parts_of.iterates(column))
    costs = [f"{_column_title(column)} {_parts_time(of, best[direct])}" for column, of in compared.items()
             if parts_of.iterates(column)]
    return f"Best is {', '.join(told)}. What is best for {_column_title(direct)} costs {', '.join(costs)} times the least."


def _parts_time(of_column, parts):
    time, _ = of_column.get(parts, (math.nan, math.nan))
    return "never" if math.isinf(time) else text.number(time)


def _in_parallel(rows, compared):
    return "".join(f" `{solver}` with `{'+'.join(parts)}` takes on two threads {text.number(over_single)} of the time of one "
                   f"part on one, and {text.number(over_same)} of that of the same parts on one."
                   for solver, (parts, over_single, over_same) in parts_of.in_parallel(rows, compared).items())


def iterative_partitions(stored):
    rows = need(stored.table(*PARTS), "partitions of solvers that iterate", "interface_rows")
    compared = parts_of.compare(rows)
    columns = list(compared)
    lines = [["+".join(parts), *(_parts_cell(column, compared[column][parts]) for column in columns)]
             for parts in compared[columns[0]]]
    agreed = ", ".join(f"{_column_title(one)} and {_column_title(other)} {parts_of.ranks_agree(compared, one, other):.2f}"
                       for place, one in enumerate(columns) for other in columns[place + 1:]
                       if one[0] == other[0] or one[1] == other[1])
    threads = "one thread where no other number is told" if threads_of(rows) else threads_in_words(())
    return ("t_pr + t_s of a partition against the least of all partitions, geometric mean over steps of the scenes "
            f"at cfm {float(parts_of.CFM):g}, {threads}; in brackets the same of sweeps. Solvers that iterate stop at "
            f"{text.power(parts_of.LIMIT)} m/s (`{COMMAND}`; {stored.origin(PARTS[0])}):\n\n" +
            text.table(["", *map(_column_title, columns)], lines) +
            f"\n\n{_which_partition(compared)}{_in_parallel(rows, compared)}\n\nRank correlation of the partitions' "
            f"times: {agreed}.")


def model_savings(stored):
    """--model auto against full."""
    found = savings_of.savings(need(stored.table(*MODEL), "rows that can matter", "case"))
    lines = [[f"{case}, {bodies} bodies, mu {float(mu):g}", text.number(of.full_ms), f"{of.ratio:.2f}",
              f"{of.least:.2f} to {of.most:.2f}", *(f"{100 * share:.1f} %" for share in (of.left_out, of.at_rest, of.returned)),
              text.number(of.largest_difference_m_per_s)] for (case, bodies, mu), of in found.items()]
    return (f"`exact`, one thread (`{MODEL[1]}`; {stored.origin(MODEL[0])}): mean t_s with every row, that of `auto` as a "
            "multiple of it, the least and most of such a ratio over steps, shares of the rows that were left out, at rest "
            "and brought back, and the largest difference of a velocity from that of the solve which moved the scene:\n\n" +
            text.table(["", "`full`, ms", "`auto`", "over steps", "left out", "at rest", "brought back", "difference, m/s"],
                       lines))


BLOCKS = {"model_savings": model_savings, "time_to_accuracy": time_to_accuracy, "ode_step": ode_step, "crossover": crossover,
          "sweep_cost": sweep_cost, "motion": motion, "iterative_partitions": iterative_partitions}
