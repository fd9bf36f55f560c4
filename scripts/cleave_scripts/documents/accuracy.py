"""Speed against accuracy: time to a residual, what a motion becomes, which parts solvers that iterate want, and what leaving rows
out saves."""
import math
import statistics

from cleave_scripts.documents.stored import need
from cleave_scripts.measurements import model_savings as savings_of
from cleave_scripts.measurements import partitions_of_solvers as parts_of
from cleave_scripts.measurements.accuracy import EXACT, LEAST_SWEEPS, problems, sweep_costs
from cleave_scripts.measurements.crossover import AXES, LIMITS as CROSSED, exact_is_faster
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


def time_to_accuracy(stored):
    rows = need(stored.table(*TIMES), "time to accuracy", "status")
    lines = []
    for problem in problems(rows):
        crossover = problem.crossover()
        lines.append([problem.title, text.number(problem.time_ms(EXACT, SHOWN[-1])), *(_against(problem, limit) for limit in SHOWN),
                      text.power(crossover) if crossover else "none"])
    return (f"t_s of `{EXACT}`, ms, one thread, on recorded steps; then the fastest of the solvers that iterate, told to stop at a residual (m/s "
            "over max(1, largest free velocity)), as a multiple of that: below 1 it is faster, *never* means that none got there in the sweeps "
            f"it was given; last the largest residual from which on down `{EXACT}` is faster than all of them "
            f"(`{COMMAND}`; {stored.origin(TIMES[0])}):\n\n" +
            text.table(["", f"`{EXACT}`, ms", *map(text.power, SHOWN), "`exact` faster from"], lines))


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
    return (f"Where `{EXACT}` is faster than every solver that iterates, on rock piles of which one thing changes, by the residual those were told to "
            f"stop at; between measured values by straight lines in logarithms (`{COMMAND}`; {stored.origin(TIMES[0])}):\n\n" +
            text.table(["", *map(text.power, CROSSED)], lines))


def sweep_cost(stored):
    """What a sweep costs each solver that iterates."""
    found = sweep_costs(need(stored.table(*TIMES), "solvers that iterate", "iterations"))
    lines = [[f"`{solver}`", len(costs), *(text.number(cost) for cost in (statistics.median(costs), min(costs), max(costs)))]
             for solver, costs in found.items()]
    return (f"ns a row and sweep or iteration, one thread, of the solves of at least {LEAST_SWEEPS} sweeps, looks at the residual and preparation "
            f"included (`{COMMAND}`; {stored.origin(TIMES[0])}):\n\n" + text.table(["", "solves", "median", "least", "most"], lines))


def _last_of(rows):
    return {(row["scene"], row["mover"]): row for row in rows}


def motion(stored):
    rows = need(stored.table(*MOTION), "motions", "mover")
    last = _last_of(rows)
    mean_ms = {}
    for row in rows:
        mean_ms.setdefault((row["scene"], row["mover"]), []).append(float(row["t_s_ms"]))
    lines = [[scene.replace("_", " "), mover, text.number(sum(mean_ms[scene, mover]) / len(mean_ms[scene, mover])),
              text.number(float(row["residual_m_per_s"])), text.number(1000 * float(row["max_penetration_m"])),
              text.number(1000 * float(row["joint_drift_m"])), text.number(float(row["height_m"])), text.number(float(row["kinetic_energy_j"]) / 1000),
              text.number(float(row["potential_energy_j"]) / 1000)] for (scene, mover), row in last.items()]
    return (f"Scenes that one solver alone has moved, at the end (`{COMMAND}`; {stored.origin(MOTION[0])}). t_s is the mean of the measured steps, of one "
            "substep where a step has several; height is that of the highest centre:\n\n" +
            text.table(["scene", "moved by", "t_s, ms", "residual, m/s", "penetration, mm", "joint drift, mm", "height, m", "kinetic energy, kJ",
                        "potential energy, kJ"], lines))


def _parts_cell(solver, ratios):
    time, sweeps = ratios
    if math.isinf(time):
        return "never"
    return text.number(time) + (f" ({text.number(sweeps)})" if solver in parts_of.ITERATIVE else "")


def iterative_partitions(stored):
    compared = parts_of.compare(need(stored.table(*PARTS), "partitions of solvers that iterate", "interface_rows"))
    solvers = list(compared)
    lines = [["+".join(parts), *(_parts_cell(solver, compared[solver][parts]) for solver in solvers)] for parts in compared[solvers[0]]]
    agreed = ", ".join(f"`{one}` and `{other}` {parts_of.ranks_agree(compared, one, other):.2f}"
                       for place, one in enumerate(solvers) for other in solvers[place + 1:])
    return (f"t_pr + t_s of a partition against the least of all partitions, geometric mean over steps of the scenes at cfm {float(parts_of.CFM):g}; in "
            f"brackets the same of sweeps. Solvers that iterate stop at {text.power(parts_of.LIMIT)} m/s (`{COMMAND}`; {stored.origin(PARTS[0])}):\n\n" +
            text.table(["", *(f"`{solver}`" for solver in solvers)], lines) +
            f"\n\nRank correlation of the partitions' times between solvers: {agreed}.")


def model_savings(stored):
    """--model auto against full."""
    found = savings_of.savings(need(stored.table(*MODEL), "rows that can matter", "case"))
    lines = [[f"{case}, {bodies} bodies, mu {float(mu):g}", text.number(of.full_ms), f"{of.ratio:.2f}",
              f"{of.least:.2f} to {of.most:.2f}", *(f"{100 * share:.1f} %" for share in (of.left_out, of.at_rest, of.returned)),
              text.number(of.largest_difference_m_per_s)] for (case, bodies, mu), of in found.items()]
    return (f"`exact`, one thread (`{MODEL[1]}`; {stored.origin(MODEL[0])}): mean t_s with every row, that of `auto` as a multiple of it, the least and most of "
            "such a ratio over steps, shares of the rows that were left out, at rest and brought back, and the largest difference of a "
            "velocity from that of the solve which moved the scene:\n\n" +
            text.table(["", "`full`, ms", "`auto`", "over steps", "left out", "at rest", "brought back", "difference, m/s"], lines))


BLOCKS = {"model_savings": model_savings, "time_to_accuracy": time_to_accuracy, "crossover": crossover, "sweep_cost": sweep_cost, "motion": motion, "iterative_partitions": iterative_partitions}
