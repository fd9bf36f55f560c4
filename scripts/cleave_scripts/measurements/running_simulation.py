"""What scripts/running_simulation measured: steps of a scene by the exact solver, with and without a session, in sweeps of
projected Gauss-Seidel over the rows of the same steps."""
import dataclasses
import statistics

from cleave_scripts.results.command_line import counted
from cleave_scripts.table import text


@dataclasses.dataclass(frozen=True)
class Scene:
    last: int  # so many steps at the end count
    most: int | None = None  # steps that are run, whatever was asked for
    options: tuple = ()


# A silo stands from the start, and the factor of one of so many boxes is dear enough that a session carries it.
SCENES = {"rock_pile": Scene(200), "log_tower": Scene(500), "silo": Scene(40, 50, ("--bodies", 800))}
WAYS = {0: "anew", 1: "session"}  # the column session
SWEEPS = 300  # of a solve by Gauss-Seidel, so that its preparation is little beside them
SOLVER, SWEEPER = "exact", f"pgs@sweeps={SWEEPS}"
REFERENCE_NS = 23  # a row and sweep on the machine that sweeps were first counted on
COLUMNS = ("scene", "bodies", "step", "session", "round", "rows", "factorizations", "factor_reuses", "cg_iterations", "t_s_ms",
           "sweep_ms", "status")
COUNTED = ("factorizations", "factor_reuses", "cg_iterations")


def steps_of(scene, asked):
    return min(asked, SCENES[scene].most or asked)


def counted_rows(solved, scene, steps):
    """A row a step that counts: that of the exact solver, and what a sweep took in the same step."""
    sweep_ms = {row["step"]: row.number("t_s_ms") / SWEEPS for row in solved if row["solver"] == SWEEPER}
    first = steps_of(scene, steps) - SCENES[scene].last
    return [{**row, "sweep_ms": f"{sweep_ms[row['step']]:.6g}"}
            for row in solved if row["solver"] == SOLVER and row.integer("step") >= first and row.integer("rows") > 0]


@dataclasses.dataclass(frozen=True)
class Cost:
    """Of a scene, with or without a session: means over the steps of medians over the rounds."""
    steps: int
    rows: float
    t_s_ms: float
    sweep_ms: float
    most_sweeps: float  # of a step
    sums: dict  # {column: sum over the steps of a round}
    above: int  # solves that are not within the limit, of all rounds

    @property
    def sweeps(self):
        return self.t_s_ms / self.sweep_ms

    @property
    def sweep_ns(self):
        """A row and sweep."""
        return 1e6 * self.sweep_ms / self.rows

    @property
    def reference_sweeps(self):
        return 1e6 * self.t_s_ms / (REFERENCE_NS * self.rows)


def _cost(rows):
    by_step = {}
    for row in rows:
        by_step.setdefault(int(row["step"]), []).append(row)
    t_s_ms, sweep_ms = ([statistics.median(float(row[name]) for row in of_step) for of_step in by_step.values()]
                        for name in ("t_s_ms", "sweep_ms"))
    firsts = [of_step[0] for of_step in by_step.values()]
    return Cost(steps=len(firsts), rows=statistics.fmean(int(row["rows"]) for row in firsts), t_s_ms=statistics.fmean(t_s_ms),
                sweep_ms=statistics.fmean(sweep_ms), most_sweeps=max(time / sweep for time, sweep in zip(t_s_ms, sweep_ms)),
                sums={name: sum(int(row[name]) for row in firsts) for name in COUNTED},
                above=sum(row["status"] != "ok" for row in rows))


def costs(rows):
    """{(scene, session): Cost}"""
    found = {}
    for row in rows:
        found.setdefault((row["scene"], int(row["session"])), []).append(row)
    return {key: _cost(of_key) for key, of_key in found.items()}


HEADER = ("", "solved", "rows", "t_s, ms", "a sweep, ns a row", "t_s in sweeps", f"in sweeps of {REFERENCE_NS} ns a row",
          "most sweeps of a step", "factorisations", "factors carried", "conjugate gradient iterations",
          "solves above the limit")


def _line(scene, session, cost):
    times = (cost.t_s_ms, cost.sweep_ns, cost.sweeps, cost.reference_sweeps, cost.most_sweeps)
    return [f"{scene.replace('_', ' ')}, last {counted(cost.steps, 'step')}", WAYS[session], f"{cost.rows:.0f}",
            *map(text.number, times), *(cost.sums[name] for name in COUNTED), cost.above]


def markdown(rows):
    """A table, and what a session saves."""
    found = costs(rows)
    return text.table(HEADER, [_line(*key, cost) for key, cost in found.items()]) + f"\n\n{_saved(found)}"


def _saved(found):
    """Of the scenes that were solved both ways."""
    def ratio(scene, value):
        return text.two_decimals(value(found[scene, 1]) / value(found[scene, 0]))
    both = [scene for scene, session in found if session == 1 and (scene, 0) in found]
    times, counts = ([f"{ratio(scene, value)} on {scene.replace('_', ' ')}" for scene in both]
                     for value in (lambda cost: cost.t_s_ms, lambda cost: cost.sums["factorizations"]))
    return f"With a session, of what a step takes without one: t_s {text.listed(times)}; factorisations {text.listed(counts)}."
