"""What becomes of a scene that one solver alone moves: ordinary solvers, and QuickStep in small steps of one iteration each, as
engines step today (Macklin et al., Small Steps in Physics Simulation, 2019)."""
import dataclasses

from cleave_scripts.measurements.friction_of_models import places
from cleave_scripts.results.command import say
from cleave_scripts.results.programs import run
from cleave_scripts.results.steps import load_steps

SCENES = ("chain_drop", "log_tower", "rock_pile", "large_rock_pile")
STEP_S = 1 / 60
MEASURED = 10  # times a motion
MOTION_COLUMNS = ("scene", "mover", "step", "time_s", "rows", "iterations", "residual_m_per_s", "max_penetration_m", "joint_drift_m",
                  "height_m", "kinetic_energy_j", "potential_energy_j", "t_s_ms", "status")


@dataclasses.dataclass(frozen=True)
class Mover:
    """A solver that advances a world, in so many substeps a step."""
    name: str
    solver: str
    options: tuple = ()
    substeps: int = 1

    def arguments(self, steps):
        return ("--solver", self.solver, "--advance", self.solver, *self.options, "--steps", steps * self.substeps,
                "--measure-every", max(1, steps // MEASURED) * self.substeps, "--dt", repr(STEP_S / self.substeps))


def _quickstep(iterations, substeps):
    text = f"ode-quickstep, {iterations} iterations" if substeps == 1 else f"ode-quickstep, {substeps} substeps of {iterations}"
    return Mover(text, "ode-quickstep", ("--quickstep-iterations", iterations), substeps)


SWEEPS = 100
OTHERS = ("pgs@order=random", "pgs@order=height", "pgs@order=propagation", "jacobi-split", "pgs-parts", "split-domains")
MOVERS = (Mover("exact", "exact"),
          *(Mover(f"{name}, {sweeps} sweeps", f"{name}@sweeps={sweeps}") for name in ("pgs", "pgs-colored", "apgd")
            for sweeps in (20, 100, 500)),
          *(Mover(f"{name}, {SWEEPS} sweeps", f"{name}@sweeps={SWEEPS}") for name in OTHERS),
          *(_quickstep(iterations, 1) for iterations in (20, 100)), *(_quickstep(1, substeps) for substeps in (5, 20)))


def motion_rows(program, scratch, steps):
    """A row a scene, mover and measured step, as in steps.csv; `mover` is the mover's name, height_m that of the highest centre."""
    for scene in SCENES:
        for mover in MOVERS:
            say(f"{scene} moved by {mover.name}")
            run([program, "run", "--scene", scene, "--partitioner", "mindp", "--refiner", "none", *mover.arguments(steps), "--repeats",
                 1, "--record-motion", "--out", scratch / "motion", "--force"], allowed=(0, 2))
            reached = places(scratch / "motion" / "motion.h5")
            for row in load_steps(scratch / "motion" / "steps.csv")[0]:
                yield {**row, "mover": mover.name, "height_m": repr(reached[row.integer("step")][0])}
