"""What becomes of a scene under each friction model, and what one step of it becomes: box with frozen bounds, box with bounds
iterated to its own normal impulses, the convex cone, and Coulomb's law."""
import h5py
import numpy

from cleave_scripts.results.command import say
from cleave_scripts.results.errors import ResultError
from cleave_scripts.results.manifest import load_manifest
from cleave_scripts.results.paper import SCENES
from cleave_scripts.results.programs import record, run
from cleave_scripts.results.steps import load_steps

MODELS = ("box", "box-converged", "cone", "coulomb")
CONVERGED, LAW = "box-converged", "coulomb"
# Models that are held against LAW in the same recorded steps, by the model that moved the scene there. Bounds converge while a
# scene is moved, and files hold them: those steps are of another motion.
MOVED_BY = {"box": ("box", "cone"), CONVERGED: (CONVERGED,)}
IN_A_STEP = tuple(model for models in MOVED_BY.values() for model in models)
RUN_OUT_SHARE = 0.95  # of the mass
MEASURED = 10  # times a motion
EXACT = ("--solver", "exact", "--repeats", 1)
MOTION_COLUMNS = ("scene", "bodies", "friction", "step", "time_s", "height_m", "run_out_m", "kinetic_energy_j",
                  "potential_energy_j", "max_penetration_m", "joint_drift_m", "bound_mismatch", "friction_beyond_share",
                  "factorizations", "residual_m_per_s", "status", "unsolved_steps")
VELOCITY_COLUMNS = ("scene", "bodies", "step", "rows", "friction", "largest_difference_m_per_s", "rms_difference_m_per_s",
                    "rms_velocity_m_per_s", "factorizations", "status", "status_of_law")


def height_m(position):
    """Of the highest centre."""
    return float(position[:, 2].max())


def run_out_m(position, mass_kg, centre):
    """Horizontal distance from a centre within which that share of the mass lies."""
    distance = numpy.hypot(*(position[:, :2] - centre).T)
    order = numpy.argsort(distance, kind="stable")
    reached = numpy.cumsum(mass_kg[order]) >= RUN_OUT_SHARE * mass_kg.sum() * (1 - 1e-12)
    return float(distance[order][reached][0])


def places(path):
    """{step: (height, run-out)} of motion.h5, the centre being that of the mass at the first step."""
    with h5py.File(path) as file:
        steps, positions, mass_kg = (file[name][()] for name in ("step", "position", "mass"))
    centre = mass_kg @ positions[0, :, :2] / mass_kg.sum()
    return {int(step): (height_m(position), run_out_m(position, mass_kg, centre)) for step, position in zip(steps, positions)}


def motion_rows(program, scratch, steps, scenes=SCENES):
    """A row a scene, model and measured step: columns of steps.csv, and where the bodies then are."""
    for scene in scenes:
        for model in MODELS:
            say(f"{scene} under {model}")
            every = max(1, steps // MEASURED)
            run([program, "run", "--scene", scene, *EXACT, "--friction", model, "--steps", steps, "--measure-every", every,
                 "--record-motion", "--out", scratch / "motion", "--force"], allowed=(0, 2))
            reached = places(scratch / "motion" / "motion.h5")
            unsolved = load_manifest(scratch / "motion")["result"]["inexact_advances"]
            for row in load_steps(scratch / "motion" / "steps.csv")[0]:
                height, run_out = reached[row.integer("step")]
                yield {**row, "friction": model, "height_m": repr(height), "run_out_m": repr(run_out),
                       "unsolved_steps": unsolved}


def velocity_rows(program, scratch, steps, scenes=SCENES):
    """A row a scene, recorded step and model: how far its velocities are from those of Coulomb's law in the same step."""
    every = max(1, steps // MEASURED)
    at = range(every, steps, every)
    for scene in scenes:
        for moved_by, models in MOVED_BY.items():
            say(f"{scene} moved under {moved_by}: one step under {', '.join(models)} and {LAW}")
            files = record(program, scratch / "steps", scene, at, "--advance", "exact", "--friction", moved_by, all_ok=False)
            yield from _differences_of(program, scratch, files, models)


def _differences_of(program, scratch, files, models):
    solved = {model: _solved(program, scratch / model, files, model) for model in (*models, LAW)}
    for file in files:
        law_row, law = solved[LAW][file.name]
        for model in models:
            row, velocity = solved[model][file.name]
            yield {**row, "friction": model, "status_of_law": law_row["status"], **_differences(velocity, law)}


def _differences(velocity, law):
    difference = numpy.linalg.norm(velocity[:, :3] - law[:, :3], axis=1)
    return {"largest_difference_m_per_s": repr(float(difference.max())), "rms_difference_m_per_s": repr(_rms(difference)),
            "rms_velocity_m_per_s": repr(_rms(numpy.linalg.norm(law[:, :3], axis=1)))}


def _rms(values):
    return float(numpy.sqrt(numpy.mean(values**2)))


def _solved(program, directory, files, model):
    """{name of file: (row, velocities)}; of CONVERGED as recorded."""
    friction = () if model == CONVERGED else ("--friction", model)
    run([program, "replay", *files, *EXACT, *friction, "--write-solutions", "--out", directory, "--force"], allowed=(0, 2))
    rows = load_steps(directory / "steps.csv")[0]
    return {file.name: (row, _velocity(directory / file.name)) for file, row in zip(files, rows, strict=True)}


def _velocity(path):
    with h5py.File(path) as file:
        solutions = list(file.get("solution", {}).values())
        if len(solutions) != 1:
            raise ResultError(f"{path}: holds {len(solutions)} solutions, expected one")
        return solutions[0]["velocity"][()]
