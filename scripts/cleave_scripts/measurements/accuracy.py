"""What scripts/tradeoff measured: how long every solver takes to a residual, and what its answers do to a motion.

A residual is held against a limit as the judge does it: divided by max(1, largest free velocity). A solver that iterates was
told to stop at each limit (`@until`); of its solves that are within a limit the fastest counts. A direct solver has one time
for all limits that its residual meets. Where no solve is within a limit the time is infinite: never.
"""
import collections
import dataclasses
import math

from cleave_scripts.results.names import NO_PARTITIONER
from cleave_scripts.results.rows import combination, has_parts, relative_residual, total_ms

KEY = ("series", "scene", "bodies", "mass_ratio", "cfm", "step")
COLUMNS = (*KEY, "rows", "solver", "partitioner", "refiner", "iterations", "residual_m_per_s", "largest_free_velocity_m_per_s", "t_pr_ms",
           "t_s_ms", "status")
DRAWN = ("paper", "mechanisms")  # series with a panel a problem
LIMITS = tuple(10.0**-power for power in range(1, 9))
EXACT = "exact"
LEAST_SWEEPS = 100
REFUSES = "lemke-max-rows"
BUDGET = ("until", "sweeps", "quickstep-iterations")  # parameters that say how long to go on, not what is done


@dataclasses.dataclass(frozen=True)
class Problem:
    """One recorded step. times_ms: {method: {limit: ms, infinite for never}}; iterative: methods that were told how long to go on."""
    key: tuple
    rows: int
    times_ms: dict
    iterative: tuple

    @property
    def scene(self):
        return self.key[KEY.index("scene")]

    @property
    def bodies(self):
        return int(self.key[KEY.index("bodies")])

    @property
    def mass_ratio(self):
        return float(self.key[KEY.index("mass_ratio")])

    @property
    def cfm(self):
        return float(self.key[KEY.index("cfm")])

    @property
    def is_drawn(self):
        return self.key[KEY.index("series")] in DRAWN

    @property
    def title(self):
        ratio = f", mass ratio {self.mass_ratio:g}" if self.mass_ratio != 1 else ""
        return f"{self.scene.replace('_', ' ')}, {self.bodies} bodies{ratio}, {self.rows} rows, cfm {self.cfm:g}"

    def time_ms(self, method, limit):
        return self.times_ms[method][limit]

    def fastest(self, limit, methods):
        """(method, ms) of the first fastest of these."""
        return min(((method, self.time_ms(method, limit)) for method in methods), key=lambda pair: pair[1])

    def against_exact(self, limit):
        """The fastest of those that iterate, as a multiple of EXACT: infinite where none gets there."""
        return self.fastest(limit, self.iterative)[1] / self.time_ms(EXACT, limit)

    def crossover(self):
        """The largest limit from which on down EXACT is faster than all that iterate; None where it is not even at the last."""
        found = None
        for limit in reversed(LIMITS):
            if self.against_exact(limit) < 1:
                break
            found = limit
        return found


def method_of(row):
    """A solver's text without its budget, and the parts it was given."""
    name, *parameters = row["solver"].split("@")
    kept = [text for text in parameters if text.partition("=")[0] not in (*BUDGET, REFUSES)]
    parts = f", {combination(row)}" if has_parts(row) else ""
    return "@".join([name, *kept]) + parts


def sweep_costs(rows):
    """{solver that iterates: [ns a row and sweep]} of its solves of at least LEAST_SWEEPS sweeps, beside which preparation counts for little."""
    found = {}
    for row in rows:
        sweeps = int(row["iterations"])
        if "@until=" in row["solver"] and sweeps >= LEAST_SWEEPS:
            found.setdefault(method_of({**row, "partitioner": NO_PARTITIONER}), []).append(1e6 * float(row["t_s_ms"]) / sweeps / int(row["rows"]))
    return found


def _key(row):
    return tuple(row[name] for name in KEY)


def of_whole_steps(rows):
    """The rows of steps that have as many as any: a table that was cut short ends with a step of fewer."""
    counts = collections.Counter(map(_key, rows))
    most = max(counts.values(), default=0)
    return [row for row in rows if counts[_key(row)] == most]


def problems(rows):
    """[Problem], in the order of their first rows."""
    found = {}
    for row in rows:
        count, times, iterative = found.setdefault(_key(row), (int(row["rows"]), {}, {}))
        method = method_of(row)
        reached = times.setdefault(method, dict.fromkeys(LIMITS, math.inf))
        if any(f"@{name}=" in row["solver"] for name in BUDGET):
            iterative[method] = True
        for limit in LIMITS:
            if relative_residual(row) <= limit:
                reached[limit] = min(reached[limit], total_ms(row))
    return [Problem(key, count, times, tuple(iterative)) for key, (count, times, iterative) in found.items()]


def profile(found, limit):
    """{method: sorted ratios of its time to the fastest on each problem, infinite where it never got there} (Dolan and More,
    Mathematical Programming 91, 2002). Problems that nobody solved are left out; all need the same methods."""
    solved = [problem for problem in found if not math.isinf(problem.fastest(limit, problem.times_ms)[1])]
    methods = list(solved[0].times_ms) if solved else []
    return {method: sorted(problem.time_ms(method, limit) / problem.fastest(limit, problem.times_ms)[1] for problem in solved)
            for method in methods}


def failures(ratios):
    return sum(math.isinf(ratio) for ratio in ratios)
