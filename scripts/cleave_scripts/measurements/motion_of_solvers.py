"""What becomes of a scene that one solver alone moves: ordinary solvers, and QuickStep in small steps of one iteration each, as
engines step today (Macklin et al., Small Steps in Physics Simulation, 2019)."""
import dataclasses

from cleave_scripts.measurements.friction_of_models import places
from cleave_scripts.results.command import say
from cleave_scripts.results.programs import run
from cleave_scripts.results.steps import load_steps

SCENES = ("chain_drop", "log_tower", "rock_pile", "large_rock_pile")
SMALL = "rock_pile", 25  # scene and bodies: few enough rows for solvers whose time grows with their cube
STEP_S = 1 / 60
MEASURED = 10  # times a motion
NEEDED = ("scene", "mover", "step", "time_s", "rows", "iterations", "residual_m_per_s", "max_penetration_m", "joint_drift_m",
          "height_m", "kinetic_energy_j", "potential_energy_j", "t_s_ms", "status")
MOTION_COLUMNS = (*NEEDED, "bodies")  # files of earlier commits lack the last


@dataclasses.dataclass(frozen=True)
class Mover:
    """A solver that advances a world, in so many substeps a step."""
    name: str
    solver: str
    options: tuple = ()
    substeps: int = 1
    partitioner: str = "mindp"
    refiner: str = "none"

    def arguments(self, steps):
        return ("--partitioner", self.partitioner, "--refiner", self.refiner, "--solver", self.solver, "--advance", self.solver,
                *self.options, "--steps", steps * self.substeps, "--measure-every", max(1, steps // MEASURED) * self.substeps,
                "--dt", repr(STEP_S / self.substeps))


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
EXACT_AS_WELL = (Mover("interior-point:monolithic", "interior-point:monolithic"),
                 Mover("schur, mix+fm", "schur", partitioner="mix", refiner="fm"))
OF_FEW_ROWS = (Mover("lemke", "lemke"), Mover("ode-step", "ode-step"))  # which refuse more than their default
OF_SMALL = (*MOVERS, *EXACT_AS_WELL, *OF_FEW_ROWS)
# Scene, options, who moves it.
CASES = (*((scene, (), MOVERS) for scene in SCENES), (SMALL[0], ("--bodies", SMALL[1]), OF_SMALL))


def motion_rows(program, scratch, steps):
    """A row a scene, mover and measured step, as in steps.csv; `mover` is the mover's name,
    height_m that of the highest centre."""
    for scene, options, movers in CASES:
        for mover in movers:
            say(f"{' '.join(map(str, (scene, *options)))} moved by {mover.name}")
            run([program, "run", "--scene", scene, *options, *mover.arguments(steps), "--repeats", 1, "--record-motion",
                 "--out", scratch / "motion", "--force"], allowed=(0, 2))
            reached = places(scratch / "motion" / "motion.h5")
            for row in load_steps(scratch / "motion" / "steps.csv")[0]:
                yield {**row, "mover": mover.name, "height_m": repr(reached[row.integer("step")][0])}


@dataclasses.dataclass(frozen=True)
class Motion:
    """A scene that a mover moved: rows of its measured steps, dictionaries of text."""
    scene: str
    bodies: str  # "" in a file of an earlier commit
    mover: str
    rows: tuple

    @property
    def place(self):
        return self.scene, self.bodies

    @property
    def title(self):
        return self.scene.replace("_", " ") + (f", {self.bodies} bodies" if self.bodies else "")

    @property
    def last(self):
        return self.rows[-1]

    @property
    def substeps(self):
        return next((mover.substeps for mover in OF_SMALL if mover.name == self.mover), 1)

    @property
    def family(self):
        """The solver, whatever its budget; in small steps it is another."""
        return self.mover.partition(",")[0] + (", small steps" if self.substeps > 1 else "")

    @property
    def mean_ms(self):
        """t_s of a measured step, of a substep where a step has several."""
        return sum(float(row["t_s_ms"]) for row in self.rows) / len(self.rows)

    @property
    def step_ms(self):
        """t_s of a whole step."""
        return self.substeps * self.mean_ms

    @property
    def later(self):
        """The second half of the measured steps, when most has come to rest."""
        return self.rows[len(self.rows) // 2:]

    def mean_later(self, column):
        return sum(float(row[column]) for row in self.later) / len(self.later)


def motions(rows):
    """[Motion], in the order of their first rows."""
    found = {}
    for row in rows:
        found.setdefault((row["scene"], row.get("bodies", ""), row["mover"]), []).append(row)
    return [Motion(*key, tuple(of_mover)) for key, of_mover in found.items()]
