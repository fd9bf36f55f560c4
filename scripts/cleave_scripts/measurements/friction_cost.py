"""What scripts/friction_cost runs: the same recorded steps under the box and under another friction model, in turn.

Cones: rock piles at every decade of compliance, moved by the exact box, a few steps from zero impulses by the interior point
alone. Coulomb's law: scenes that the law moves, every step from the impulses of the step before by `exact`.
"""
import dataclasses
import pathlib

from cleave_scripts.measurements.friction_law import friction_mismatch
from cleave_scripts.results.programs import record, replay

COLUMNS = ("scene", "bodies", "cfm", "step", "cold", "round", "friction", "solver", "rows", "iterations", "factorizations",
           "residual_m_per_s", "largest_free_velocity_m_per_s", "bound_mismatch", "friction_mismatch", "t_s_ms",
           "t_s_waiting_ms", "status")
BOX, CONE, LAW = "box", "cone", "coulomb"
ROCKS = ("200", "600")
CFMS = tuple(f"1e-{power}" for power in range(4, 15))
CONE_STEPS = (100, 150, 200, 250, 300)  # a pile falls and comes to rest
CONE_OPTIONS = ("--solver", "interior-point:monolithic", "--cold", "--repeats", 5)
SCENES = ("rock_pile", "large_rock_pile")
LAW_OPTIONS = ("--solver", "exact", "--repeats", 3)  # the first after a file is read finds no memory at hand
SIDE_BY_SIDE = 25  # steps that are replayed under one model before the other has its turn


@dataclasses.dataclass
class Case:
    name: str
    scene: str
    steps: tuple
    moved: tuple  # options of `cleave record`
    models: tuple
    options: tuple  # of `cleave replay`
    files: list = ()

    def record(self, program, directory):
        """On two threads, which give the same steps sooner."""
        self.files = record(program, directory / self.name.replace(" ", "_"), self.scene, self.steps, "--advance", "exact",
                            "--repeats", 1, "--threads", 2, *self.moved, all_ok=False)

    def replay(self, program, directory, number):
        """A row a step with a constraint and model. The models take turns, and in rounds of an odd number the box begins."""
        models = self.models if number % 2 else self.models[::-1]
        for first in range(0, len(self.files), SIDE_BY_SIDE):
            for model in models:
                yield from self._replayed(program, directory / "replay", self.files[first:first + SIDE_BY_SIDE], model, number)

    def _replayed(self, program, directory, files, model, number):
        """The impulses of the law are looked at in the first round; those of later ones are the same."""
        looked_at = LAW in self.models and number == 1
        rows = replay(program, directory, files, *self.options, "--friction", model, "--threads", 1,
                      *["--write-solutions"] * looked_at)
        for file, row in zip(files, rows, strict=True):
            if row.integer("rows") > 0:
                mismatch = friction_mismatch(directory / pathlib.Path(file).name) if looked_at else float("nan")
                yield {**row, "round": number, "friction_mismatch": f"{mismatch:.3g}"}


def cone_cases(rocks, cfms):
    return [Case(f"{bodies} rocks, cfm {cfm}", "rock_pile", CONE_STEPS, ("--bodies", bodies, "--cfm", cfm), (BOX, CONE),
                 CONE_OPTIONS) for bodies in rocks for cfm in cfms]


def law_cases(scenes, steps):
    """steps: that are solved, of a motion."""
    return [Case(scene.replace("_", " "), scene, steps, ("--friction", LAW), (BOX, LAW), LAW_OPTIONS) for scene in scenes]
