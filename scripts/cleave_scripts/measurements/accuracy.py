"""What scripts/tradeoff measured: how long every solver takes to a residual, and what its answers do to a motion.

A residual is held against a limit as the judge does it: divided by max(1, largest free velocity). A solver that iterates was
told to stop at each limit (`@until`), as far as it got: its sweeps for the next would be the same again. Of its solves that are
within a limit the fastest counts. A direct solver has one time for all limits that its residual meets. Where no solve is within
a limit the time is infinite: never. A solver that refuses a step, which has more rows than it takes, has not failed on it and
is counted apart.
"""
import dataclasses
import math

from cleave_scripts.results.names import NO_PARTITIONER, said_parameters
from cleave_scripts.results.rows import combination, has_parts, relative_residual, total_ms

KEY = ("series", "scene", "bodies", "mass_ratio", "cfm", "step")
NEEDED = (*KEY, "rows", "solver", "partitioner", "refiner", "iterations", "residual_m_per_s", "largest_free_velocity_m_per_s",
          "t_pr_ms", "t_s_ms", "status")
COLUMNS = (*NEEDED, "threads", "kinetic_energy_j")  # files of earlier commits lack the last two
SETTLED = "settled"  # series of piles that have come to rest
DRAWN = ("paper", "mechanisms", "default", SETTLED)  # series with a panel a problem
LIMITS = tuple(10.0**-power for power in range(1, 9))
EXACT, ODE_STEP = "exact", "ode-step"
ASKED_OF_ODE_STEP, ASKED_AT_ROWS = 15, 500  # times as long as EXACT, on a settled step of about so many rows
TIMES_AS_FAST, AT_LIMIT = 10, 1e-6  # as the fastest that iterates
LEAST_SWEEPS = 100
ASKED_OF_PGS, ASKED_OF_SWEEPS = 20, 25  # ns a row and sweep: of pgs in its natural order, of every solver that iterates
REFUSES = ("lemke-max-rows", "ode-step-max-rows")
BUDGET = ("until", "sweeps", "quickstep-iterations")  # parameters that say how long to go on, not what is done


@dataclasses.dataclass(frozen=True)
class Problem:
    """One recorded step. times_ms: {method: {limit: ms, infinite for never}}; iterative: methods that were told how long to go
    on; refused: those that did not try; threads: of its solves, as texts, of a file that has them; kinetic_energy_j: NaN where
    a file has none."""
    key: tuple
    rows: int
    times_ms: dict
    iterative: tuple
    refused: tuple = ()
    threads: tuple = ()
    kinetic_energy_j: float = math.nan

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
    def is_settled(self):
        return self.key[KEY.index("series")] == SETTLED

    @property
    def place(self):
        return f"{self.scene.replace('_', ' ')}, {self.bodies} bodies"

    @property
    def _ratio(self):
        return f"mass ratio {self.mass_ratio:g}, " if self.mass_ratio != 1 else ""

    @property
    def _stiffness(self):
        return f"cfm {self.cfm:g}{', settled' if self.is_settled else ''}"

    @property
    def title(self):
        return f"{self.place}, {self._ratio}{self.rows} rows, {self._stiffness}"

    @property
    def case(self):
        """What tells it from the others of its place."""
        return self._ratio + self._stiffness

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
    kept = [text for text in parameters if text.partition("=")[0] not in (*BUDGET, *REFUSES)]
    parts = f", {combination(row)}" if has_parts(row) else ""
    return "@".join([name, *kept]) + parts


def until(row):
    """The limit that it was told to stop at; None where it was told none."""
    text = said_parameters(row["solver"]).get("until")
    return None if text is None else float(text)


def within(row, limit):
    return relative_residual(row) <= limit  # which NaN is not


def sweep_costs(rows):
    """{solver that iterates: [ns a row and sweep]} of its solves of at least LEAST_SWEEPS sweeps,
    beside which preparation counts for little."""
    found = {}
    for row in rows:
        if until(row) is None:
            continue
        costs, sweeps = found.setdefault(method_of({**row, "partitioner": NO_PARTITIONER}), []), int(row["iterations"])
        if sweeps >= LEAST_SWEEPS:
            costs.append(1e6 * float(row["t_s_ms"]) / sweeps / int(row["rows"]))
    return {solver: costs for solver, costs in found.items() if costs}


def asked_of_a_sweep(solver):
    return ASKED_OF_PGS if solver == "pgs" else ASKED_OF_SWEEPS


def _key(row):
    return tuple(row[name] for name in KEY)


def of_whole_steps(rows):
    """The rows of steps that have every solve, of a solver with limits down to the least or to one that it did not get to: a
    table that was cut short ends with a step that has not."""
    steps = {}
    for row in rows:
        steps.setdefault(_key(row), []).append(row)
    methods, without_limit = set(map(method_of, rows)), {row["solver"] for row in rows if until(row) is None}
    least = min((until(row) for row in rows if until(row) is not None), default=0)

    def is_whole(of_step):
        last = {method_of(row): row for row in of_step}
        ended = all(until(row) in (None, least) or not within(row, until(row)) for row in last.values())
        return ended and set(last) == methods and {row["solver"] for row in of_step if until(row) is None} == without_limit

    return [row for of_step in steps.values() if is_whole(of_step) for row in of_step]


def problems(rows):
    """[Problem], in the order of their first rows."""
    steps = {}
    for row in rows:
        steps.setdefault(_key(row), []).append(row)
    return [_problem(key, of_step) for key, of_step in steps.items()]


def _problem(key, rows):
    times, iterative, statuses = {}, {}, {}
    for row in rows:
        method = method_of(row)
        reached = times.setdefault(method, dict.fromkeys(LIMITS, math.inf))
        statuses.setdefault(method, set()).add(row["status"])
        if any(name in said_parameters(row["solver"]) for name in BUDGET):
            iterative[method] = True
        for limit in LIMITS:
            if within(row, limit):
                reached[limit] = min(reached[limit], total_ms(row))
    return Problem(key, int(rows[0]["rows"]), times, tuple(iterative),
                   tuple(method for method, found in statuses.items() if found == {"refused"}),
                   threads_of(rows), float(rows[0].get("kinetic_energy_j", "nan")))


def threads_of(rows):
    """The numbers of threads in the rows, as texts; () of a file without the column."""
    return tuple(dict.fromkeys(row["threads"] for row in rows if "threads" in row))


def threads_in_words(threads):
    return ("one thread" if threads == ("1",) else f"{' or '.join(threads)} threads" if threads else
            "number of threads not recorded")


def solved(found, limit):
    """The problems that somebody solved to a limit."""
    return [problem for problem in found if not math.isinf(problem.fastest(limit, problem.times_ms)[1])]


def profile(found, limit):
    """{method: sorted ratios of its time to the fastest on each problem, infinite where it never got there} (Dolan and More,
    Mathematical Programming 91, 2002). Problems that nobody solved are left out; all need the same methods."""
    compared = solved(found, limit)
    methods = list(compared[0].times_ms) if compared else []
    return {method: sorted(problem.time_ms(method, limit) / problem.fastest(limit, problem.times_ms)[1] for problem in compared)
            for method in methods}


def failures(found, method, limit):
    """On how many problems that somebody solved a method tried and did not get there."""
    return sum(math.isinf(problem.time_ms(method, limit)) and method not in problem.refused for problem in solved(found, limit))


def refusals(found, method):
    return sum(method in problem.refused for problem in found)


def settled_piles(found):
    """The settled steps in ascending rows."""
    return sorted((problem for problem in found if problem.is_settled), key=lambda problem: problem.rows)
