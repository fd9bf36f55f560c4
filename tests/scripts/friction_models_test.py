"""scripts/friction_models: what is made of positions, velocities and bounds,
and the command with a stand-in for the program."""
import csv
import math
import pathlib
import re
import tempfile
import unittest

import h5py
import numpy
import stored_data
from stand_in import NOTES_ITS_CALL, StandInCase
from synthetic import PROGRAM, ROOT

from cleave_scripts.documents import friction
from cleave_scripts.documents.stored import Stored
from cleave_scripts.measurements.bound_ratios import bounds_of, verdict
from cleave_scripts.measurements.friction_bounds import (COLUMNS as BOUND_COLUMNS, DEFAULT_SWEEPS, SWEEPS, TIMED,
                                                         carried_mismatch, mismatch_of)
from cleave_scripts.measurements.friction_law import solved_arrays
from cleave_scripts.measurements.friction_of_models import (EXACT, IN_A_STEP, MODELS, MOTION_COLUMNS, VELOCITY_COLUMNS,
                                                            places, run_out_m)
from cleave_scripts.results.paper import SCENES
from cleave_scripts.results.programs import record, replay

STAND_IN = NOTES_ITS_CALL + """import friction_models_test
sys.exit(friction_models_test.answer(words, given))
"""
SPEED = {"box": 1.0, "box-converged": 1.5, "cone": 3.0, "coulomb": 2.0}  # of the first of two bodies, by model
UNSOLVED = "coulomb"


def write_motion(path, positions, mass_kg=(1.0, 1.0)):
    with h5py.File(path, "w") as file:
        file["step"], file["position"], file["mass"] = (numpy.arange(len(positions)), numpy.array(positions, dtype=float),
                                                        numpy.array(mass_kg))


def write_solution(path, speed):
    """With a contact that carried 3 N s in the step before and carries 4."""
    with h5py.File(path, "w") as file:
        file["solution/-+-+exact/velocity"] = numpy.array([[speed, 0, 0, 9, 9, 9], [0, 2.0, 0, 0, 0, 0]])
        file["solution/-+-+exact/impulse"] = numpy.array([4.0, 1, 1])
        for name, values in contacts([3.0, 9, 9]).items():
            file[name] = values


def contacts(warm_impulse, mu=0.5):
    """Of a normal and two tangents each."""
    rows = len(warm_impulse)
    is_tangent = numpy.arange(rows) % 3 > 0
    return {"warm_impulse": numpy.array(warm_impulse, dtype=float),
            "friction_row": numpy.where(is_tangent, numpy.arange(rows) // 3 * 3, -1),
            "friction_coefficient": numpy.where(is_tangent, mu, 0)}


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
                               t_s_ms=8, bound_mismatch=2e-6 * (step % 2),
                               status="not_converged" if model == UNSOLVED and step == 1 else "ok")
                          for step, file in enumerate(files)])
        return 2
    steps, every = int(given["--steps"]), int(given["--measure-every"])
    if "@" in model:
        write_steps(out, bounds_moved(given["--scene"], int(model.partition("=")[2]), range(every - 1, steps, every)))
        return 2
    write_motion(out / "motion.h5", [[[step, 0, 1], [-step, 0, 2]] for step in range(steps)])
    energies = {name: 1500 for name in ("kinetic_energy_j", "potential_energy_j")}
    write_steps(out, [dict(common, scene=given["--scene"], step=step, time_s=step / 60, max_penetration_m=0.25, joint_drift_m=0,
                           bound_mismatch="nan", friction_beyond_share="nan", residual_m_per_s=1e-15, **energies)
                      for step in range(every - 1, steps, every)])
    write_manifest(out, result={"inexact_advances": 7 if model == UNSOLVED else 0})
    return 0


def bounds_moved(scene, sweeps, at):
    """Nothing is touched before step 4, the step after is not solved, and a sweep takes a hundredth of a solve."""
    rows = [dict(scene=scene, bodies=2, seed=1, step=step, solver="exact", rows=6 * step,
                 status="not_converged" if step == 5 else "ok", t_s_ms=step,
                 bound_mismatch=0.5 / (1 + sweeps) if step >= 4 else "nan", friction_beyond_share=0.25 if step >= 4 else "nan")
            for step in at]
    return rows + [{**row, "solver": TIMED, "status": "not_converged", "bound_mismatch": 9} for row in rows]


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


class BoundsTest(unittest.TestCase):

    def test_impulses_of_the_step_before_are_held_against_those_of_the_solution(self):
        for warm, own, mismatch in (([4, 9, 9], [4, 0, 0], 0), ([3, 9, 9], [4, 0, 0], 0.25), ([6, 9, 9], [4, 0, 0], 0.5),
                                    ([-3, 9, 9], [4, 0, 0], 1), ([4, 9, 9, 1, 9, 9], [2, 0, 0, 2, 0, 0], 0.75),
                                    ([4, 9, 9, 2, 9, 9], [-1, 0, 0, 2, 0, 0], 2)):
            with self.subTest(warm):
                self.assertAlmostEqual(mismatch_of(contacts(warm) | {"impulse": numpy.array(own, dtype=float)}), mismatch)
        self.assertTrue(math.isnan(mismatch_of(contacts([3, 9, 9]) | {"impulse": numpy.zeros(3)})))
        self.assertTrue(math.isnan(mismatch_of(contacts([3, 9, 9], mu=0) | {"impulse": numpy.ones(3)})))

    def test_of_the_program(self):
        """Its own column says the same of bounds that no sweep has changed;
        and a file starts from the solution of the step before."""
        with tempfile.TemporaryDirectory() as name:
            scratch = pathlib.Path(name)
            for model in ("box@bound-sweeps=0", "box-converged"):
                files = record(PROGRAM, scratch, "rock_pile", (40, 41), "--bodies", 20, "--repeats", 1, "--friction", model)
                rows = replay(PROGRAM, scratch / model, files, *EXACT, "--write-solutions")
                found = [carried_mismatch(scratch / model / file.name) for file in files]
                if model != "box-converged":
                    self.assertGreater(found[0], 0.01)
                    for row, mismatch in zip(rows, found, strict=True):
                        self.assertAlmostEqual(row.number("bound_mismatch"), mismatch, delta=1e-6 * mismatch)
            before, after = (solved_arrays(scratch / model / file.name, ("warm_impulse",), ("impulse",)) for file in files)
        carried = after["warm_impulse"][after["warm_impulse"] != 0]
        self.assertGreater(len(carried), 0)
        self.assertLess(numpy.abs(carried[:, None] - before["impulse"]).min(axis=1).max(), 1e-9 * numpy.abs(carried).max())

    def test_the_default_is_that_of_the_program(self):
        text = (ROOT / "harness" / "world" / "extract.h").read_text()
        self.assertEqual(int(re.search(r"kBoundSweeps = (\d+);", text)[1]), DEFAULT_SWEEPS)

    def test_what_halves_the_mismatch_and_what_it_costs(self):
        """A sweep is a hundredth of a solve on the chain, a tenth elsewhere."""
        rows = [dict(scene=scene, start=start, bound_sweeps=sweeps, bound_mismatch=mismatch,
                     unsettled=7, t_s_ms=10, sweep_ms=0.1 if scene == "chain_drop" else 1)
                for scene, mismatches, carried in (("chain_drop", (0.5, 0.4, 0.21, 0.2), 0.2),
                                                   ("log_tower", (0.5, 0.4, 0.2, 0.1), 0.21),
                                                   ("rock_pile", (0.5, 0.4, 0.3, 0.21), 0.1),
                                                   ("large_rock_pile", (0.1, 0.4, 0.3, 0.25), 0.4))
                for start, sweeps, mismatch in (*zip(["frozen"] * 4, (0, 5, 10, 20), mismatches), ("converged", 0, carried))]
        chain, *_, large = bounds_of(rows)
        self.assertEqual((chain.halving, large.halving, chain.carried), (20, 0, 0.2))
        self.assertAlmostEqual(chain.cost(20), 0.15)
        self.assertEqual(verdict(rows), "Halved at no more than 5 % of t_s: on large rock pile by 0 sweeps. "
                         "What halves it costs 15.0 % on chain drop (20 sweeps) and 50.0 % on log tower (10 sweeps). "
                         "No number of sweeps here halves it on rock pile. The converged impulses of the step before, "
                         "without a sweep, halve it on chain drop and rock pile.")
        self.assertEqual(large.unsettled, 7)
        for row in rows:
            row["sweep_ms"] = 0.01
        self.assertTrue(verdict(rows).startswith("Halved at no more than 5 % of t_s: on chain drop by 20 sweeps, "
                                                 "log tower by 10 sweeps and large rock pile by 0 sweeps. No number"))
        self.assertTrue(verdict(rows[10:15]).startswith("Halved at no more than 5 % of t_s: on none. "
                                                        "No number of sweeps here halves it on rock pile."))


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
        self.run_it("--steps", 100, "--tables", "velocities,motion")
        calls = self.calls()
        self.assertEqual(sum(call.startswith("run ") for call in calls), len(SCENES) * len(MODELS))
        self.assertEqual(sum(call.startswith("replay ") for call in calls), len(SCENES) * (len(IN_A_STEP) + 2))
        self.assertIn("record --scene rock_pile --at 10,20,30,40,50,60,70,80,90 ", " ".join(calls))
        velocities, moved = self.tables()
        self.assertEqual(len(velocities), len(SCENES) * 9 * len(IN_A_STEP))
        self.assertEqual({(row["friction"], row["largest_difference_m_per_s"]) for row in velocities},
                         {("box", "1.0"), ("cone", "1.0"), ("box-converged", "0.5")})
        self.assertAlmostEqual(float(velocities[0]["rms_difference_m_per_s"]), 0.5**0.5)
        self.assertEqual(float(velocities[0]["rms_velocity_m_per_s"]), 2)
        self.assertEqual([row["status_of_law"] for row in velocities[:4]], ["ok", "ok", "not_converged", "not_converged"])
        self.assertEqual(len(moved), len(SCENES) * len(MODELS) * 10)
        self.assertEqual((moved[-1]["step"], moved[-1]["run_out_m"], moved[-1]["height_m"], moved[-1]["unsolved_steps"]),
                         ("99", "99.0", "2.0", "7"))

    def test_bounds_of_a_scene_by_every_number_of_sweeps(self):
        scenes = ("chain_drop", "log_tower")
        self.run_it("--steps", 20, "--scene", ",".join(scenes), "--tables", "bounds")
        calls = " ".join(self.calls())
        self.assertEqual(calls.count("run --scene"), len(scenes) * len(SWEEPS))
        self.assertIn("run --scene log_tower --steps 20 --measure-every 1 --friction box@bound-sweeps=50 "
                      "--solver exact,pgs@sweeps=100 --threads 1 ", calls)
        self.assertIn(f"record --scene log_tower --at {','.join(map(str, range(20)))} --advance exact --repeats 1 --threads 2 "
                      "--friction box-converged ", calls)
        with open(self.directory / "out" / "friction_bounds.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual((tuple(rows[0]), len(rows)), (BOUND_COLUMNS, len(scenes) * (len(SWEEPS) + 1)))
        self.assertEqual(list(rows[3].values()),
                         ["chain_drop", "2", "frozen", "5", "15", "1", "-", "71.6", repr(0.5 / 6), "0.25", "12.0", "0.12"])
        self.assertEqual(list(rows[8].values()),
                         ["chain_drop", "2", "converged", "0", "20", "0", "10", "6.0", "0.25", "nan", "8.0", "nan"])
        stored_data.write_provenance(self.directory / "out", "friction_bounds.csv")
        told = friction.friction_bounds(Stored(self.directory / "out"))
        self.assertIn("Some CPU, 2 cores, commit 0123456789", told)
        self.assertIn("| sweeps in 5 % of t_s | 0 sweeps | 1 sweep | 2 sweeps |", told)
        self.assertIn("| chain drop | 12.0 | 0.120 | 5.00 | 50.0 (-5.00) | 25.0 (-4.00) | 16.7 (-3.00) | 8.33 | 4.55 (5.00) | "
                      "2.38 (15.0) |", told)
        self.assertIn(" | 25.0 (10) |", told)
        self.assertIn("Halved at no more than 5 % of t_s: on none. What halves it costs 15.0 % on chain drop (20 sweeps) and "
                      "15.0 % on log tower (20 sweeps). The converged", told)

    def test_steps_are_measured_fifty_times_a_motion(self):
        self.run_it("--steps", 500, "--scene", "chain_drop", "--tables", "bounds")
        calls = " ".join(self.calls())
        self.assertIn("--steps 500 --measure-every 10 ", calls)
        self.assertIn("--at 9,19,29,", calls)

    def test_a_motion_without_a_contact_has_a_row(self):
        self.run_it("--steps", 4, "--scene", "chain_drop", "--tables", "bounds")
        with open(self.directory / "out" / "friction_bounds.csv", newline="") as file:
            row = next(csv.DictReader(file))
        self.assertEqual((row["steps"], row["rows"], row["bound_mismatch"], row["sweep_ms"]), ("0", "nan", "nan", "nan"))

    def test_the_document_tells_them(self):
        self.run_it("--steps", 20, "--scene", "chain_drop", "--tables", "velocities,motion")
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
        self.check_refused((("--scene", "rocks"), "--scene has 'rocks'"), (("--tables", "all"), "--tables has 'all'"),
                           (("--steps", 1), "--steps is '1'"))


if __name__ == "__main__":
    unittest.main()
