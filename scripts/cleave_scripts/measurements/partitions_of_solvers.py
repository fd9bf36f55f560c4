"""Does a solver that iterates want other parts than a direct one? The same recorded steps, every partition, and what solvers make of it.

A solver that iterates is told to stop at LIMIT; what counts is t_pr + t_s until then, and the number of its sweeps.
"""
import math
import statistics

from cleave_scripts.results.names import base_name
from cleave_scripts.results.programs import replay
from cleave_scripts.results.rows import relative_residual, total_ms

KEY = ("scene", "bodies", "cfm", "step")
REFINERS = ("none", "fm")
DIRECT = ("schur", "auto:schur-bodies")
ITERATIVE = ("pgs-parts", "split-domains")
LIMIT = 1e-4
CFM = "1e-4"  # where those that iterate get to LIMIT
COLUMNS = (*KEY, "rows", "solver", "partitioner", "refiner", "interface_rows", "iterations", "t_pr_ms", "t_s_ms", "status",
           "residual_m_per_s", "largest_free_velocity_m_per_s")


def partition_rows(program, scratch, files, most_sweeps, threads):
    solvers = (*DIRECT, *(f"{name}@until={LIMIT:g}@sweeps={most_sweeps}" for name in ITERATIVE))
    yield from replay(program, scratch / "parts", files, "--solver", ",".join(solvers), "--partitioner", "all",
                      "--refiner", ",".join(REFINERS), "--threads", threads, "--repeats", 3)


def _cost(row, number):
    return number(row) if relative_residual(row) <= LIMIT else math.inf


def _ratios(rows, number):
    """{(partitioner, refiner): geometric mean over problems of its number against the least of all; infinite where one problem was
    not solved to LIMIT}, of the rows of one solver."""
    of_problem = {}
    for row in rows:
        of_problem.setdefault(tuple(row[name] for name in KEY), {})[row["partitioner"], row["refiner"]] = _cost(row, number)
    ratios = {}
    for costs in of_problem.values():
        least = min(costs.values())
        if math.isinf(least):
            continue  # nobody got there
        for parts, cost in costs.items():
            ratios.setdefault(parts, []).append(cost / least)
    return {parts: math.inf if math.inf in found else statistics.geometric_mean(found) for parts, found in ratios.items()}


def solver_name(row):
    return base_name(row["solver"])


def compare(rows):
    """{solver: {(partitioner, refiner): (ratio of t_pr + t_s, ratio of sweeps)}}; the latter NaN of direct solvers."""
    found = {}
    for solver in dict.fromkeys(map(solver_name, rows)):
        mine = [row for row in rows if solver_name(row) == solver]
        times = _ratios(mine, total_ms)
        sweeps = _ratios(mine, lambda row: float(row["iterations"])) if solver in ITERATIVE else {}
        found[solver] = {parts: (ratio, sweeps.get(parts, math.nan)) for parts, ratio in times.items()}
    return found


def ranks_agree(compared, one, other):
    """Spearman's rank correlation of the times of two solvers over the partitions; those that never got there share the last
    place."""
    parts = list(compared[one])
    return _correlation(_ranks([compared[one][key][0] for key in parts]), _ranks([compared[other][key][0] for key in parts]))


def _ranks(values):
    ordered = sorted(values)
    return [(2 * ordered.index(value) + ordered.count(value) + 1) / 2 for value in values]


def _correlation(first, second):
    means = statistics.fmean(first), statistics.fmean(second)
    pairs = [(a - means[0], b - means[1]) for a, b in zip(first, second)]
    spread = math.sqrt(sum(a * a for a, _ in pairs) * sum(b * b for _, b in pairs))
    return sum(a * b for a, b in pairs) / spread if spread else math.nan
