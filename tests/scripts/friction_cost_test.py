"""scripts/friction_cost: its own measure of Coulomb's law, what is made of its rows,
and the command with a stand-in for the program."""
import csv
import math
import pathlib
import tempfile
import unittest

import h5py
import numpy
import stored_data
from stand_in import NOTES_ITS_CALL, StandInCase
from synthetic import PROGRAM

from cleave_scripts.documents import friction
from cleave_scripts.documents.stored import Stored
from cleave_scripts.measurements.friction_cost import COLUMNS, SIDE_BY_SIDE, cone_cases, law_cases
from cleave_scripts.measurements.friction_law import mismatch_of
from cleave_scripts.measurements.friction_ratios import cone_costs, law_costs

STAND_IN = NOTES_ITS_CALL + """import friction_cost_test
friction_cost_test.answer(words, given)
"""
MU, MASS_KG = 0.5, 2.0


def sliding(impulse, velocity, tangents=2):
    """A body on contacts with the ground that all act at its centre: impulses (contacts, 1 + tangents),
    its velocity along normal and tangents."""
    impulse = numpy.array(impulse, dtype=float)
    rows = impulse.size
    jacobian, axes = numpy.zeros((rows, 12)), 1 + tangents
    jacobian[numpy.arange(rows), numpy.arange(rows) % axes] = 1
    normal = numpy.arange(rows) // axes * axes
    is_tangent = numpy.arange(rows) % axes > 0
    return {"mass": MASS_KG * numpy.eye(6)[None], "row_body": numpy.tile([0, -1], (rows, 1)), "jacobian": jacobian,
            "rhs": numpy.zeros(rows), "compliance": numpy.zeros(rows), "friction_row": numpy.where(is_tangent, normal, -1),
            "friction_coefficient": numpy.where(is_tangent, MU, 0), "impulse": impulse.ravel(),
            "velocity": numpy.array([[*velocity, *[0] * (6 - len(velocity))]], dtype=float)}


def answer(words, given):
    """As the program does. Under Coulomb's law the friction of steps up to 9 is that of the box; two steps have no row."""
    from synthetic import touch_recorded, write_steps
    if words[0] == "record":
        return touch_recorded(given)
    out = pathlib.Path(given["--out"])
    out.mkdir(parents=True, exist_ok=True)
    files = [pathlib.Path(word) for word in words if word.endswith(".h5")]
    model, cold = given["--friction"], int("--cold" in words)
    rows = []
    for file in files:
        step = int(file.stem[-6:])
        rows.append(dict(scene=file.name.partition("_step")[0], bodies=200, cfm="1.0000000000000001e-05", step=step, cold=cold,
                         friction=model, solver=given["--solver"], rows=9 * (step > 1),
                         iterations=46 if (model, step) == ("cone", 300) else 20, factorizations=22, residual_m_per_s=1e-15,
                         largest_free_velocity_m_per_s=2, bound_mismatch=0.1, t_s_ms=10 if model == "box" else 14,
                         t_s_waiting_ms=0, status="not_converged" if (model, step) == ("coulomb", 2) else "ok"))
        if "--write-solutions" in words:
            write_solved(out / file.name, sliding([[4, 1 if model == "box" or step < 10 else 2, 0]], (0, -1, 0)))
    write_steps(out, rows)


def write_solved(path, arrays):
    with h5py.File(path, "w") as file:
        for name, values in arrays.items():
            file[f"solution/-+-+exact/{name}" if name in ("impulse", "velocity") else name] = values


class LawTest(unittest.TestCase):

    def test_what_follows_the_law_has_none(self):
        for impulses, velocity in (([[4, -1, 1.5], [4, 2, 0]], (0, 0, 0)), ([[4, -1.2, 1.6], [2, -0.6, 0.8]], (0, 3, -4)),
                                   ([[4, 0, -2], [0, 0, 0]], (9, 0, 1e-9))):
            with self.subTest(impulses):
                self.assertAlmostEqual(mismatch_of(sliding(impulses, velocity)), 0, places=14)

    def test_impulses_that_are_missed_are_shares_of_what_friction_may_carry(self):
        for impulse, missed in (([4, 1, 0], 1), ([4, 3, 0], 1), ([4, 2, 1.5], 1.5), ([4, 0, -2], 8**0.5), ([-1, 0, 0], 0)):
            with self.subTest(impulse):  # so fast a body asks for mu n against its sliding
                found = mismatch_of(sliding([[4, 2, 0], impulse], (0, -1e9, 0)))
                self.assertAlmostEqual(found, missed / (MU * (4 + max(0, impulse[0]))))

    def test_friction_that_would_stop_a_body_need_be_no_more(self):
        self.assertAlmostEqual(mismatch_of(sliding([[40, 0, 0]], (0, -1, 0))), MASS_KG / (MU * 40))

    def test_a_tangent_alone_and_what_carries_nothing(self):
        self.assertAlmostEqual(mismatch_of(sliding([[4, 1], [4, -2]], (0, -9), tangents=1)), 5 / 4)
        self.assertTrue(math.isnan(mismatch_of(sliding([[0, 0, 0]], (1, 1, 1)))))

    def test_of_the_program(self):
        """A falling pile whose law was solved, and whose box was."""
        with tempfile.TemporaryDirectory() as scratch:
            case, = law_cases(["rock_pile"], [40])
            case.moved += ("--bodies", 20)
            case.record(PROGRAM, pathlib.Path(scratch))
            rows = {row["friction"]: row for row in case.replay(PROGRAM, pathlib.Path(scratch), 1)}
        self.assertLess(float(rows["coulomb"]["friction_mismatch"]), 1e-9)
        self.assertGreater(float(rows["box"]["friction_mismatch"]), 1e-3)


def rows_of(cold, friction, times_ms, **others):
    """Rows of a step each, of two rounds of which the second takes twice as long."""
    return [{"scene": "rock_pile", "bodies": "200", "cfm": "1e-08", "cold": cold, "friction": friction, "step": step,
             "round": number, "t_s_ms": t_s_ms * number, "t_s_waiting_ms": t_s_ms * number / 4, "iterations": 9 + step,
             "status": "ok", "friction_mismatch": 1e-7} | others
            for number in (1, 2) for step, t_s_ms in enumerate(times_ms)]


class RatiosTest(unittest.TestCase):

    def test_times_are_medians_over_rounds_and_ratios_of_a_step(self):
        cost = cone_costs(rows_of(1, "box", (10, 20, 40)) + rows_of(1, "cone", (15, 40, 40)))[200, 1e-8]
        self.assertEqual((cost.steps, cost.median_ratio, max(cost.ratios), cost.iterations["cone"]), (3, 1.5, 2, 11))
        self.assertAlmostEqual(cost.ratio_of_sums("cone"), 95 / 70)
        self.assertEqual(cost.t_s_ms["box"], 35)
        self.assertTrue(cost.cone_holds())

    def test_a_cone_that_is_slow_or_iterates_long_or_is_not_solved_does_not_hold(self):
        box = rows_of(1, "box", (10, 10))
        for spoiled in (rows_of(1, "cone", (15, 16)), rows_of(1, "cone", (1, 1), iterations=46),
                        rows_of(1, "cone", (1, 1), status="not_converged")):
            self.assertFalse(cone_costs(box + spoiled)[200, 1e-8].cone_holds())

    def test_a_law_that_is_slow_or_missed_does_not_hold(self):
        box = rows_of(0, "box", (10,) * 20)

        def holds(*times_ms, missed=0):
            rows = rows_of(0, "coulomb", times_ms)
            for row in rows:
                row["friction_mismatch"] = 2e-6 if row["step"] < missed else "nan" if row["step"] > 17 and not missed else 1e-6
            return law_costs(box + rows)["rock_pile"].law_holds()

        self.assertTrue(holds(*(60,) * 20))
        self.assertTrue(holds(*(60,) * 20, missed=1))
        self.assertFalse(holds(*(60,) * 20, missed=2))
        self.assertFalse(holds(*(1,) * 9, *(61,) * 11))  # in the median
        self.assertFalse(holds(*(1,) * 11, *(200,) * 9))  # of sums

    def test_what_the_readme_says(self):
        root = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        stored_data.write_csv(root / "friction_cost.csv", rows_of(1, "box", (10, 20)) + rows_of(1, "cone", (15, 40)) +
                              rows_of(0, "box", (10, 20, 5), friction_mismatch=0.1) +
                              rows_of(0, "coulomb", (30, 40, 30), status="not_converged"))
        stored_data.write_provenance(root, "friction_cost.csv")
        told = friction.friction_cost(Stored(root))
        self.assertIn("medians of 2 rounds", told)
        self.assertIn("Threads waited 165 ms for a core, in solves of 660 ms.", told)
        self.assertIn("0 of 1 hold: the cone", told)
        self.assertIn("| 200 | 1e-8 | 2 | 22.5 | 41.2 | 1.75 | 2.00 | 10 | 10 | 0 | 0 | no |", told)
        self.assertIn("1 of 1 hold: at least 95 % of the steps are within 1e-6", told)
        self.assertIn("| rock pile | 3 | 17.5 | 50.0 | 2.86 | 3.00 | 0 of 3, 0.0 % | 3 of 3, 100.0 % | 0 | 3 | yes |", told)


class FrictionCostTest(StandInCase):
    stand_in, script = STAND_IN, "friction_cost"

    def test_models_take_turns(self):
        said = self.run_it("--rocks", 200, "--cfm", "1e-5", "--scene", "rock_pile", "--steps", 40).stdout
        calls = [call.partition(" --out")[0].split(" ") for call in self.calls()]
        self.assertEqual([" ".join(call[:5]) for call in calls[:2]],
                         ["record --scene rock_pile --at 100,150,200,250,300",
                          "record --scene rock_pile --at " + ",".join(map(str, range(40)))])
        self.assertIn("--bodies 200 --cfm 1e-5", " ".join(calls[0]))
        self.assertIn("--threads 2 --friction coulomb", " ".join(calls[1]))
        replayed = [(call[call.index("--friction") + 1], sum(word.endswith(".h5") for word in call),
                     "--write-solutions" in call, "--cold" in call)
                    for call in calls[2:]]
        first, rest = SIDE_BY_SIDE, 40 - SIDE_BY_SIDE
        self.assertEqual(replayed, [("box", 5, False, True), ("cone", 5, False, True)] +
                         [(model, count, True, False) for count in (first, rest) for model in ("box", "coulomb")] +
                         [("cone", 5, False, True), ("box", 5, False, True)] +
                         [(model, count, False, False) for count in (first, rest) for model in ("coulomb", "box")])
        self.assertTrue(all(call[call.index("--threads") + 1] == "1" for call in calls[2:]))
        with open(self.directory / "out" / "friction_cost.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual((tuple(rows[0]), len(rows)), (COLUMNS, 2 * 2 * (5 + 38)))
        self.assertIn("| 200 | 1e-5 | 5 | 10.0 | 14.0 | 1.40 | 1.40 | 20 | 46 | 0 | 0 | no |", said)
        self.assertIn("| rock pile | 38 | 10.0 | 14.0 | 1.40 | 1.40 | 0 of 38, 0.0 % | 30 of 38, 78.9 % | 0 | 1 | no |", said)

    def test_every_pile_and_decade(self):
        names = [case.name for case in cone_cases(("200", "600"), ("1e-4", "1e-14"))]
        self.assertEqual(names, ["200 rocks, cfm 1e-4", "200 rocks, cfm 1e-14", "600 rocks, cfm 1e-4", "600 rocks, cfm 1e-14"])

    def test_what_is_not_measured_is_not_told(self):
        self.assertNotIn("Coulomb", self.run_it("--rocks", 200, "--cfm", "1e-5", "--scene", "rock_pile", "--steps", 1,
                                                "--rounds", 1).stdout)

    def test_bad_options_are_one_line(self):
        self.check_refused((("--rocks", 300), "--rocks has '300'"), (("--cfm", "1e-3"), "--cfm has '1e-3'"),
                           (("--rounds", 0), "--rounds is '0'"),
                           (("--steps", 3, "--measure-every", 4), "--measure-every is '4'"))


if __name__ == "__main__":
    unittest.main()
