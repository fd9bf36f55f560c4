"""scripts/friction_models: what is made of positions and velocities, and the command with a stand-in for the program."""
import csv
import pathlib
import tempfile
import unittest

import h5py
import numpy
import stored_data
from stand_in import NOTES_ITS_CALL, StandInCase

from cleave_scripts.documents import friction
from cleave_scripts.documents.stored import Stored
from cleave_scripts.measurements.friction_of_models import IN_A_STEP, MODELS, MOTION_COLUMNS, VELOCITY_COLUMNS, places, run_out_m
from cleave_scripts.results.paper import SCENES

STAND_IN = NOTES_ITS_CALL + """import friction_models_test
sys.exit(friction_models_test.answer(words, given))
"""
SPEED = {"box": 1.0, "box-converged": 1.5, "cone": 3.0, "coulomb": 2.0}  # of the first of two bodies, by model
UNSOLVED = "coulomb"


def write_motion(path, positions, mass_kg=(1.0, 1.0)):
    with h5py.File(path, "w") as file:
        file["step"], file["position"], file["mass"] = numpy.arange(len(positions)), numpy.array(positions, dtype=float), numpy.array(mass_kg)


def write_solution(path, speed):
    with h5py.File(path, "w") as file:
        file["solution/-+-+exact/velocity"] = numpy.array([[speed, 0, 0, 9, 9, 9], [0, 2.0, 0, 0, 0, 0]])


def answer(words, given):
    """As the program does: two bodies, of which one moves away by a metre a step."""
    from synthetic import touch_recorded, write_manifest, write_steps
    if words[0] == "record":
        touch_recorded(given)
        return 0
    out = pathlib.Path(given["--out"])
    out.mkdir(parents=True, exist_ok=True)
    model = given.get("--friction", "box-converged")  # of a replay: as recorded
    common = dict(bodies=2, rows=6, status="ok", status_reason="-", factorizations=4, seed=1)
    if words[0] == "replay":
        files = [pathlib.Path(word) for word in words if word.endswith(".h5")]
        for file in files:
            write_solution(out / file.name, SPEED[model])
        write_steps(out, [dict(common, scene=file.name.partition("_step")[0], step=int(file.stem[-6:]),
                               status="not_converged" if model == UNSOLVED and step == 1 else "ok") for step, file in enumerate(files)])
        return 2
    steps, every = int(given["--steps"]), int(given["--measure-every"])
    write_motion(out / "motion.h5", [[[step, 0, 1], [-step, 0, 2]] for step in range(steps)])
    energies = {name: 1500 for name in ("kinetic_energy_j", "potential_energy_j")}
    write_steps(out, [dict(common, scene=given["--scene"], step=step, time_s=step / 60, max_penetration_m=0.25, joint_drift_m=0,
                           bound_mismatch="nan", friction_beyond_share="nan", residual_m_per_s=1e-15, **energies)
                      for step in range(every - 1, steps, every)])
    write_manifest(out, result={"inexact_advances": 7 if model == UNSOLVED else 0})
    return 0


class PlacesTest(unittest.TestCase):

    def test_run_out_is_where_so_much_of_the_mass_lies(self):
        position = numpy.array([[0.1 * k, 0, 5] for k in range(101)])
        self.assertAlmostEqual(run_out_m(position, numpy.ones(101), numpy.zeros(2)), 9.5)
        heavy = numpy.ones(101)
        heavy[-1] = 1e4
        self.assertAlmostEqual(run_out_m(position, heavy, numpy.zeros(2)), 10)
        self.assertAlmostEqual(run_out_m(numpy.array([[3.0, 4, 0]]), numpy.ones(1), numpy.zeros(2)), 5)

    def test_the_middle_is_that_of_the_mass_at_the_first_step(self):
        with tempfile.TemporaryDirectory() as scratch:
            path = pathlib.Path(scratch) / "motion.h5"
            write_motion(path, [[[0, 0, 1], [4, 0, 3]], [[1, 3, 8], [1, 0, 3]]], (3.0, 1.0))
            self.assertEqual(places(path), {0: (3.0, 3.0), 1: (8.0, 3.0)})


class FrictionModelsTest(StandInCase):
    stand_in, script = STAND_IN, "friction_models"

    def tables(self):
        out = self.directory / "out"
        for name, columns in (("friction_velocities.csv", VELOCITY_COLUMNS), ("friction_motion.csv", MOTION_COLUMNS)):
            with open(out / name, newline="") as file:
                rows = list(csv.DictReader(file))
            self.assertEqual(tuple(rows[0]), columns)
            yield rows

    def test_every_scene_under_every_model(self):
        self.run_it("--steps", 100)
        calls = self.calls()
        self.assertEqual(sum(call.startswith("run ") for call in calls), len(SCENES) * len(MODELS))
        self.assertEqual(sum(call.startswith("replay ") for call in calls), len(SCENES) * (len(IN_A_STEP) + 2))
        self.assertIn("record --scene rock_pile --at 10,20,30,40,50,60,70,80,90 ", " ".join(calls))
        velocities, moved = self.tables()
        self.assertEqual(len(velocities), len(SCENES) * 9 * len(IN_A_STEP))
        self.assertEqual({(row["friction"], row["largest_difference_m_per_s"]) for row in velocities}, {("box", "1.0"), ("cone", "1.0"), ("box-converged", "0.5")})
        self.assertAlmostEqual(float(velocities[0]["rms_difference_m_per_s"]), 0.5**0.5)
        self.assertEqual(float(velocities[0]["rms_velocity_m_per_s"]), 2)
        self.assertEqual([row["status_of_law"] for row in velocities[:4]], ["ok", "ok", "not_converged", "not_converged"])
        self.assertEqual(len(moved), len(SCENES) * len(MODELS) * 10)
        self.assertEqual((moved[-1]["step"], moved[-1]["run_out_m"], moved[-1]["height_m"], moved[-1]["unsolved_steps"]), ("99", "99.0", "2.0", "7"))

    def test_the_document_tells_them(self):
        self.run_it("--steps", 20, "--scene", "chain_drop")
        stored_data.write_provenance(self.directory / "out", "friction_motion.csv", "friction_velocities.csv")
        stored = Stored(self.directory / "out")
        self.assertIn("| chain drop | cone | 8 of 9 | 35", friction.friction_velocities(stored))
        told = friction.friction_motion(stored)
        self.assertIn("after 20 steps", told)
        self.assertIn("| chain drop | coulomb | 2.00 | 19.0 | 1.50 | 1.50 | 250 | 4.00 | 7 |", told)

    def test_one_table_alone(self):
        self.run_it("--steps", 20, "--scene", "chain_drop", "--tables", "velocities")
        self.assertEqual([path.name for path in (self.directory / "out").iterdir()], ["friction_velocities.csv"])
        self.assertEqual({call.split()[0] for call in self.calls()}, {"record", "replay"})

    def test_bad_options_are_one_line(self):
        self.check_refused((("--scene", "rocks"), "--scene has 'rocks'"), (("--tables", "all"), "--tables has 'all'"), (("--steps", 1), "--steps is '1'"))


if __name__ == "__main__":
    unittest.main()
