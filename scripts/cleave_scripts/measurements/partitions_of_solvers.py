"""Does a solver that iterates want other parts than a direct one? The same recorded steps, every partition,
and what solvers make of it.

A solver that iterates is told to stop at LIMIT; what counts is t_pr + t_s until then, and the number of its sweeps. It works on
its parts in parallel, so it has two threads besides.
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
TWO = 2  # threads
ONE_PART = ("single", "none")
COLUMNS = (*KEY, "rows", "solver", "partitioner", "refiner", "interface_rows", "iterations", "t_pr_ms", "t_s_ms", "status",
           "residual_m_per_s", "largest_free_velocity_m_per_s", "threads")  # files of earlier commits lack the last


def partition_rows(program, scratch, files, most_sweeps, threads):
    """On that many threads, and of those that iterate on two."""
    iterative = tuple(f"{name}@until={LIMIT:g}@sweeps={most_sweeps}" for name in ITERATIVE)
    for solvers, count in (((*DIRECT, *iterative), threads), *(((iterative, TWO),) if threads != TWO else ())):
        yield from replay(program, scratch / "parts", files, "--solver", ",".join(solvers), "--partitioner", "all",
                          "--refiner", ",".join(REFINERS), "--threads", count, "--repeats", 3)


def _cost(row, number):
    return number(row) if relative_residual(row) <= LIMIT else math.inf


def _ratios(rows, number):
    """{(partitioner, refiner): geometric mean over problems of its number against the least of all; infinite where one problem
    was not solved to LIMIT}, of the rows of one solver."""
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


def iterates(column):
    return column[0] in ITERATIVE


def _columns(rows):
    """{(solver, threads): its rows}; threads "" in a file without them."""
    found = {}
    for row in rows:
        found.setdefault((solver_name(row), row.get("threads", "")), []).append(row)
    return found


def compare(rows):
    """{(solver, threads): {(partitioner, refiner): (ratio of t_pr + t_s, ratio of sweeps)}};
    the latter NaN of direct solvers."""
    found = {}
    for column, mine in _columns(rows).items():
        times = _ratios(mine, total_ms)
        sweeps = _ratios(mine, lambda row: float(row["iterations"])) if iterates(column) else {}
        found[column] = {parts: (ratio, sweeps.get(parts, math.nan)) for parts, ratio in times.items()}
    return found


def best_parts(of_column):
    """The first (partitioner, refiner) of least time."""
    return min(of_column, key=lambda parts: of_column[parts][0])


def _costs(rows, parts):
    """{problem: t_pr + t_s with that (partitioner, refiner)}"""
    return {tuple(row[name] for name in KEY): _cost(row, total_ms)
            for row in rows if (row["partitioner"], row["refiner"]) == parts}


def _mean_ratio(costs, base):
    ratios = [cost / base[problem] for problem, cost in costs.items()
              if math.isfinite(cost) and math.isfinite(base.get(problem, math.inf))]
    return statistics.geometric_mean(ratios) if ratios else math.nan


def in_parallel(rows, compared):
    """{solver that iterates: (its best parts on two threads, their t_pr + t_s there over that of one part on one thread, the
    same over that of the same parts on one)}, geometric means over the steps; none of a file without both numbers of
    threads."""
    columns, found = _columns(rows), {}
    for solver in ITERATIVE:
        one, two = ((solver, threads) for threads in ("1", str(TWO)))
        if one in columns and two in columns:
            parts = best_parts(compared[two])
            parallel = _costs(columns[two], parts)
            found[solver] = (parts, *(_mean_ratio(parallel, _costs(columns[one], base)) for base in (ONE_PART, parts)))
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
