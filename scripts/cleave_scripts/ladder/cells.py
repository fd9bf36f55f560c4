"""One cell of the ladder: a rung's value and a solver, run in a process of its own and judged."""
import dataclasses
import hashlib
import math
import pathlib
import statistics
import subprocess
import tempfile
import threading

from cleave_scripts.ladder import rungs
from cleave_scripts.ladder.climbers import solver_options
from cleave_scripts.ladder.rungs import ENERGY_LIMIT, HEIGHT_LIMIT_M, NAN, OVERSHOOT, PENETRATION_LIMIT_M
from cleave_scripts.results.errors import Interrupted, ResultError
from cleave_scripts.results.kept import Journal
from cleave_scripts.results.manifest import load_manifest
from cleave_scripts.results.paper import PLAIN
from cleave_scripts.results.run_key import build_key
from cleave_scripts.results.steps import load_steps

TIMED_OUT = "timed out"
# A cell has the status of its worst step; rows after a world has stopped say nothing new.
WORST_FIRST = ("crashed", "timeout", "out_of_memory", "diverged", "refused", "not_converged", "skipped", "ok")
MEASURED = ("residual_m_per_s", "iterations", "joint_drift_m", "max_penetration_m", "energy_excess_j",
            "height_error_m", "t_s_ms", "sag_m", "drift_error_m", "rows", "ode_messages")
COLUMNS = ("rung", "setup", "parameter", "value", "solver", "status", *MEASURED[:7], "first_failing", *MEASURED[7:],
           "physics", "first_failing_physics", "steps", "status_reason")


@dataclasses.dataclass(frozen=True)
class Cell:
    rung: object
    value: str
    solver: str
    steps: int

    @property
    def label(self):
        return f"{self.rung.name} {self.value} {self.solver}"

    @property
    def arguments(self):
        """What cleave is given, less where it writes. Every solver advances a world of its own."""
        options = [
            text for name, value in self.rung.settings(self.value).items() for text in (f"--{name}", value)
        ]
        return ("run", "--scene", self.rung.scene, *options, "--steps", str(self.steps), "--repeats", "1",
                "--partitioner", PLAIN[0], "--refiner", PLAIN[1], *solver_options(self.solver))


_running = set()
_stopped = threading.Event()


def stop_running():
    """Ends the programs that still run; their cells are Interrupted, and so are those that have not begun."""
    _stopped.set()
    for process in list(_running):
        process.terminate()


def run_cell(program, cell, timeout_s):
    """The columns of a cell that depend on its own run alone."""
    with tempfile.TemporaryDirectory(prefix="cleave_ladder_") as scratch:
        out = pathlib.Path(scratch) / "out"
        code, last_words = _run_program([program, *cell.arguments, "--out", str(out)], timeout_s)
        if code == TIMED_OUT:
            return failed("timeout", f"stopped after {timeout_s:g} s")
        return read_cell(cell, out, code, last_words)


def _run_program(command, timeout_s):
    """(exit code, the last line that was said)"""
    if _stopped.is_set():
        raise Interrupted
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, errors="replace")
    _running.add(process)
    if _stopped.is_set():
        process.terminate()
    try:
        _, said = process.communicate(timeout=timeout_s)
    except subprocess.TimeoutExpired:
        process.kill()
        process.communicate()
        return TIMED_OUT, ""
    finally:
        _running.discard(process)
    if process.returncode == 130:
        _stopped.set()
    if _stopped.is_set():
        raise Interrupted
    return process.returncode, (said.strip().splitlines() or ["nothing"])[-1]


def read_cell(cell, out, code, last_words):
    if code < 0:
        return failed("crashed", f"ended by signal {-code}")
    if code not in (0, 2):
        if not (out / "manifest.json").exists():
            raise ResultError(f"cleave {' '.join(cell.arguments)}: {last_words}")
        return failed("crashed", last_words)
    return judged(cell, load_steps(out / "steps.csv")[0], load_manifest(out)["result"])


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
    return cell.rung.expect(cell.rung.settings(cell.value), rows[-1].integer("step") + 1)


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
    if any(broken.values()) and float(cell.rung.settings(cell.value)["dt"]) > aim.longest_step_s:
        return "step_too_long"  # no solution of the steps would hold
    return "+".join(name for name, is_broken in broken.items() if is_broken) or "ok"


class LadderJournal(Journal):
    """Finished cells, so that a ladder can be interrupted and given again. Other judges run everything again, and a longer time
    limit what had no time."""

    def __init__(self, path, program, timeout_s):
        judges = b"".join(pathlib.Path(file).read_bytes() for file in (__file__, rungs.__file__))
        self.timeout_s = timeout_s
        super().__init__(path, build_key(program), {"judges": hashlib.sha256(judges).hexdigest(), "timeout_s": timeout_s})

    def is_valid(self, entry):
        is_final = entry["result"]["status"] != "timeout" or entry["timeout_s"] >= self.timeout_s
        return is_final and super().is_valid(entry | {"timeout_s": self.timeout_s})
