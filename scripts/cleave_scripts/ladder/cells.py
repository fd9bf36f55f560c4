"""One cell of the ladder: a rung's value and who climbs it, what the campaign is asked for, and how its run is judged."""
import dataclasses
import math
import statistics

from cleave_scripts.ladder.rungs import ENERGY_LIMIT, HEIGHT_LIMIT_M, NAN, OVERSHOOT, PENETRATION_LIMIT_M, rung_of
from cleave_scripts.results.manifest import load_manifest
from cleave_scripts.results.steps import load_steps

CAMPAIGN = "ladder_cells"  # beside ladder.csv
# A cell has the status of its worst step; rows after a world has stopped say nothing new.
WORST_FIRST = ("crashed", "timeout", "out_of_memory", "diverged", "refused", "not_converged", "skipped", "ok")
MEASURED = ("residual_m_per_s", "iterations", "joint_drift_m", "max_penetration_m", "energy_excess_j",
            "height_error_m", "t_s_ms", "sag_m", "drift_error_m", "rows", "ode_messages")
COLUMNS = ("rung", "setup", "parameter", "value", "solver", "status", *MEASURED[:7], "first_failing", *MEASURED[7:],
           "physics", "first_failing_physics", "steps", "status_reason")
SAME = ("mode", "partitioner", "refiner", "steps", "repeats")  # for all cells
DEFAULTS = {"contact-cap": 8, "copies": 1}  # of the program: rungs that give them share cells with rungs that do not


@dataclasses.dataclass(frozen=True)
class Cell:
    rung: object
    value: str
    climber: object
    steps: int

    @property
    def settings(self):
        return self.rung.settings(self.value)

    @property
    def identity(self):
        """Equal for cells of the same run."""
        return identity({**self.settings, "solver": self.climber.solver, "friction": self.climber.friction})


def identity(options):
    """Of options of cleave, those that tell one cell of the ladder from another, numbers as such."""
    numbers = {name: _number(value) for name, value in options.items()}
    return frozenset((name, value) for name, value in numbers.items() if name not in SAME and DEFAULTS.get(name) != value)


def _number(text):
    try:
        return float(text)
    except ValueError:
        return text


def ladder_spec(spec, values, climbers, steps):
    """The campaign with these values by the names of their rungs, and these climbers."""
    solvers, frictions = ([*dict.fromkeys(getattr(climber, key) for climber in climbers)] for key in ("solver", "friction"))
    pairs = {(climber.solver, climber.friction) for climber in climbers}
    others = {friction: [solver for solver in solvers if (solver, friction) not in pairs] for friction in frictions}
    return spec | {
        "solver": solvers,
        "friction": frictions,
        "steps": steps,
        "exclude": [{"friction": friction, "solver": unwanted} for friction, unwanted in others.items() if unwanted],
        "include": [asked for rule in spec["include"] if (asked := _with_values(rule, values))],
    }


def _with_values(rule, values):
    """The include with the values of its rung that are asked for; None without any."""
    name, parameter, own = rung_of(rule)
    wanted = [value for value in own if value in values.get(name, ())]
    return rule | {parameter: wanted} if wanted else None


def result_of(cell, run):
    """The columns of a cell that depend on its own run alone. run: of the campaign."""
    if not run.ran:
        return failed(run.status, run.reason)
    return judged(cell, load_steps(run.directory / "steps.csv")[0], load_manifest(run.directory)["result"])


def failed(status, reason):
    return {"status": status, "status_reason": reason, "physics": "-", **dict.fromkeys(MEASURED, NAN)}


def judged(cell, rows, result):
    status = min((row["status"] for row in rows), key=WORST_FIRST.index)
    if status == "ok" and result["inexact_advances"] > 0:
        status = "not_converged"
    reason = next((row["status_reason"] for row in rows if row["status"] == status), "-")
    solved = [row for row in rows if row["status"] in ("ok", "not_converged")]
    if not solved:
        return failed(status, reason)
    return {
        "status": status,
        "status_reason": reason,
        **measured(cell, solved),
        "physics": physics(cell, solved) if len(solved) == len(rows) else "stopped",
    }


def largest(rows, column):
    values = [row.number(column) for row in rows]
    return NAN if any(map(math.isnan, values)) else max(values)


def expected(cell, rows):
    return cell.rung.expect(cell.settings, rows[-1].integer("step") + 1)


def measured(cell, rows):
    """Worst of all steps; the height of the last one against its closed form, and the widest gap of all."""
    aim, last = expected(cell, rows), rows[-1]
    return {
        "residual_m_per_s": largest(rows, "residual_m_per_s"),
        "iterations": largest(rows, "iterations"),
        "joint_drift_m": largest(rows, "joint_drift_m"),
        "max_penetration_m": largest(rows, "max_penetration_m"),
        "energy_excess_j": largest(rows, "energy_excess_j"),
        "height_error_m": abs(last.number("last_body_z_m") - aim.height_m),
        "t_s_ms": statistics.median(row.number("t_s_ms") for row in rows),
        "sag_m": aim.sag_m,
        "drift_error_m": largest(rows, "joint_drift_m") - aim.joint_gap_m,
        "rows": largest(rows, "rows"),
        "ode_messages": sum(row.integer("ode_messages") for row in rows),
    }


def physics(cell, rows):
    """'ok', or which of the rung's limits the motion breaks, or that the time stepping breaks them by itself."""
    aim, values = expected(cell, rows), measured(cell, rows)
    gain = max(row.number("energy_excess_j") / max(1, row.number("kinetic_energy_j")) for row in rows)
    broken = {
        "height": values["height_error_m"] > HEIGHT_LIMIT_M,
        "drift": values["joint_drift_m"] > OVERSHOOT * aim.joint_gap_m + aim.drift_limit_m,
        "penetration": values["max_penetration_m"] > OVERSHOOT * aim.depth_m + PENETRATION_LIMIT_M,
        "energy": not gain <= ENERGY_LIMIT,
    }
    if any(broken.values()) and float(cell.settings["dt"]) > aim.longest_step_s:
        return "step_too_long"  # no solution of the steps would hold
    return "+".join(name for name, is_broken in broken.items() if is_broken) or "ok"
