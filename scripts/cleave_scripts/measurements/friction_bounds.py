"""How far the bounds that a box freezes are from mu times the normal impulses of its own solution, by the Gauss-Seidel sweeps
that predict them, and what a sweep costs; and how far mu times the converged impulses of the step before would be, without any
sweep."""
import math
import statistics

import numpy

from cleave_scripts.measurements.friction_law import solved_arrays
from cleave_scripts.measurements.friction_of_models import CONVERGED as CONVERGED_MODEL, EXACT
from cleave_scripts.results.command import say
from cleave_scripts.results.paper import SCENES
from cleave_scripts.results.programs import record, replay, run
from cleave_scripts.results.steps import load_steps

COLUMNS = ("scene", "bodies", "start", "bound_sweeps", "steps", "unsolved", "unsettled", "rows", "bound_mismatch",
           "friction_beyond_share", "t_s_ms", "sweep_ms")
FROZEN, CONVERGED = "frozen", "converged"  # the bounds of the step before, whose impulses the sweeps start from
DEFAULT_SWEEPS = 5  # of the program
SWEEPS = (0, 1, 2, DEFAULT_SWEEPS, 10, 20, 50, 200)
TIMED_SWEEPS = 100
TIMED = f"pgs@sweeps={TIMED_SWEEPS}"
MEASURED = 50  # steps of a motion
SETTLED = 1e-6  # mismatch of bounds that have converged: at most


def bound_rows(program, scratch, steps, scenes=SCENES):
    """A row a scene and number of sweeps, and one a scene that starts from converged impulses."""
    every = max(1, steps // MEASURED)
    for scene in scenes:
        for sweeps in SWEEPS:
            say(f"{scene} under the box, its bounds from {sweeps} sweeps")
            yield _frozen(program, scratch / "bounds", scene, sweeps, ("--steps", steps, "--measure-every", every))
        say(f"{scene} under {CONVERGED_MODEL}: impulses of the step before")
        yield _converged(program, scratch, scene, range(every - 1, steps, every))


def _frozen(program, directory, scene, sweeps, steps):
    run([program, "run", "--scene", scene, *steps, "--friction", f"box@bound-sweeps={sweeps}", "--solver", f"exact,{TIMED}",
         "--threads", 1, "--repeats", 1, "--out", directory, "--force"], allowed=(0, 2))
    rows = load_steps(directory / "steps.csv")[0]
    timed = {row["step"]: row.number("t_s_ms") / TIMED_SWEEPS for row in rows if row["solver"] == TIMED}
    exact = [{**row, "sweep_ms": timed[row["step"]]} for row in rows if row["solver"] == "exact"]
    return _row(exact, start=FROZEN, bound_sweeps=sweeps, unsettled="-")


def _converged(program, scratch, scene, at):
    """Every file starts from the impulses of the step before, whichever steps are recorded. On two threads,
    which give the same steps sooner."""
    files = record(program, scratch / "converged", scene, at, "--advance", "exact", "--repeats", 1, "--threads", 2,
                   "--friction", CONVERGED_MODEL, all_ok=False)
    rows = replay(program, scratch / "solved", files, *EXACT, "--threads", 1, "--write-solutions")
    kept = [{**row, "bound_mismatch": carried_mismatch(scratch / "solved" / file.name), "friction_beyond_share": math.nan,
             "sweep_ms": math.nan} for file, row in zip(files, rows, strict=True)]
    return _row(kept, start=CONVERGED, bound_sweeps=0, unsettled=sum(row.number("bound_mismatch") > SETTLED for row in rows))


def _row(rows, **others):
    """Of the steps that are solved and in which a contact carries anything."""
    counted = [row for row in rows if row["status"] == "ok" and not math.isnan(float(row["bound_mismatch"]))]
    medians = {name: repr(_over(counted, name, statistics.median))
               for name in ("bound_mismatch", "friction_beyond_share", "t_s_ms", "sweep_ms")}
    return {"scene": rows[0]["scene"], "bodies": rows[0]["bodies"], **others, "steps": len(counted),
            "unsolved": sum(row["status"] != "ok" for row in rows),
            "rows": repr(_over(counted, "rows", statistics.fmean)), **medians}


def _over(rows, name, middle):
    return middle(float(row[name]) for row in rows) if rows else math.nan


def carried_mismatch(path):
    """As the column bound_mismatch is for the bounds of a step, for mu times the normal impulses that a problem file starts
    from: against those of the solution in it."""
    return mismatch_of(solved_arrays(path, ("warm_impulse", "friction_row", "friction_coefficient"), ("impulse",)))


def mismatch_of(arrays):
    """NaN where no contact carries anything."""
    tangents = numpy.flatnonzero(arrays["friction_coefficient"] > 0)
    mu, normal = (arrays[name][tangents] for name in ("friction_coefficient", "friction_row"))
    bound, own = (mu * numpy.maximum(arrays[name][normal], 0) for name in ("warm_impulse", "impulse"))
    return float(numpy.abs(bound - own).sum() / own.sum()) if own.sum() > 0 else math.nan
