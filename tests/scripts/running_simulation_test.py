"""scripts/running_simulation: what is made of its rows, and the command with a stand-in for the program."""
import csv
import pathlib
import tempfile
import unittest

import stored_data
from stand_in import NOTES_ITS_CALL, StandInCase

from cleave_scripts.documents import large
from cleave_scripts.documents.stored import Stored
from cleave_scripts.measurements.running_simulation import COLUMNS, SWEEPS, WAYS, costs, counted_rows, markdown, steps_of
from cleave_scripts.results.steps import Row

# The sweeps are never within the limit, and step 7 of a session is not either.
STAND_IN = NOTES_ITS_CALL + f"""from synthetic import write_steps
session = int("--session" in words)
write_steps(pathlib.Path(given["--out"]), [
    dict(seed=1, scene=given["--scene"], bodies=9, step=step, session=session, rows=1000 * min(step, 1), solver=solver,
         t_s_ms=t_s_ms, factorizations=3 - session, factor_reuses=session, cg_iterations=4 * session,
         status="ok" if solver == "exact" and (step != 7 or not session) else "not_converged")
    for step in range(int(given["--steps"]))
    for solver, t_s_ms in (("exact", 2 - session), ("pgs@sweeps={SWEEPS}", {SWEEPS} * 0.04))])
sys.exit(int(os.environ.get("STAND_IN_CODE") or 0) or 2)
"""


class CostTest(unittest.TestCase):

    def test_medians_over_rounds_then_means_over_steps(self):
        cost, = costs(stored_data.running_simulation_rows(sessions=(0,))).values()
        self.assertEqual((cost.steps, cost.rows, cost.t_s_ms, cost.sweep_ms), (2, 1500, 3, 0.03))
        self.assertEqual((round(cost.sweeps, 9), round(cost.sweep_ns, 9), cost.reference_sweeps), (100, 20, 3e6 / (23 * 1500)))
        self.assertEqual((cost.most_sweeps, cost.sums["factorizations"], cost.above), (125, 6, 1))

    def test_only_the_last_steps_count_and_those_with_a_row(self):
        rows = [Row({"scene": "rock_pile", "step": str(step), "solver": solver, "rows": "0" if step == 450 else "9",
                     "t_s_ms": "6"}, "x", 1)
                for step in range(500) for solver in ("exact", f"pgs@sweeps={SWEEPS}")]
        found = counted_rows(rows, "rock_pile", 500)
        self.assertEqual([int(row["step"]) for row in found], [*range(300, 450), *range(451, 500)])
        self.assertEqual({(row["solver"], row["sweep_ms"]) for row in found}, {("exact", "0.02")})

    def test_a_silo_has_steps_of_its_own(self):
        self.assertEqual([steps_of("silo", asked) for asked in (500, 50, 20)], [50, 50, 20])
        self.assertEqual(steps_of("log_tower", 500), 500)
        rows = [Row({"scene": "silo", "step": str(step), "solver": solver, "rows": "9", "t_s_ms": "6"}, "x", 1)
                for step in range(50) for solver in ("exact", f"pgs@sweeps={SWEEPS}")]
        self.assertEqual([int(row["step"]) for row in counted_rows(rows, "silo", 500)], [*range(10, 50)])

    def test_what_a_session_saves_is_told_of_every_scene_with_both_ways(self):
        silo = [row | {"scene": "silo"} | ({"t_s_ms": row["t_s_ms"] * 0.9, "factorizations": 2} if row["session"] else {})
                for row in stored_data.running_simulation_rows()]
        tower = [row | {"scene": "log_tower"} for row in stored_data.running_simulation_rows(sessions=(1,))]
        told = markdown(stored_data.running_simulation_rows() + silo + tower)
        self.assertTrue(told.endswith("\n\nWith a session, of what a step takes without one: t_s 1.00 on rock pile and 0.90 on "
                                      "silo; factorisations 1.00 on rock pile and 0.67 on silo."), told)

    def test_what_the_readme_says(self):
        root = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        stored_data.write_csv(root / "running_simulation.csv", stored_data.running_simulation_rows())
        stored_data.write_provenance(root, "running_simulation.csv")
        told = large.running_simulation(Stored(root))
        self.assertIn("medians of 3 rounds", told)
        self.assertIn("| rock pile, last 2 steps | session | 1500 | 3.00 | 20.0 | 100 | 87.0 | 125 | 6 | 2 | 4 | 1 |", told)


class RunningSimulationTest(StandInCase):
    stand_in = STAND_IN
    script = "running_simulation"

    def test_every_step_is_solved_both_ways_in_turn(self):
        said = self.run_it("--steps", 20, "--rounds", 2).stdout
        calls = self.calls()
        self.assertEqual([("--session" in call) for call in calls], [False, True] * 3 + [True, False] * 3)
        self.assertEqual([call.partition(" --solver")[0] for call in calls[:6:2]],
                         ["run --scene rock_pile", "run --scene log_tower", "run --scene silo --bodies 800"])
        for call in calls:
            self.assertIn(f"--solver exact,pgs@sweeps={SWEEPS} --steps 20 --measure-every 1 --repeats 1 --threads 1 ", call)
        with open(self.directory / "out" / "running_simulation.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual((tuple(rows[0]), len(rows)), (COLUMNS, 2 * 3 * len(WAYS) * 19))
        self.assertIn("| rock pile, last 19 steps | anew | 1000 | 2.00 | 40.0 | 50.0 | 87.0 | 50.0 | 57 | 0 | 0 | 0 |", said)
        self.assertIn("| log tower, last 19 steps | session | 1000 | 1.00 | 40.0 | 25.0 | 43.5 | 25.0 | 38 | 19 | 76 | 2 |",
                      said)
        self.assertIn("| silo, last 19 steps | session | 1000 | 1.00 |", said)
        self.assertTrue(said.endswith(" t_s 0.50 on rock pile, 0.50 on log tower and 0.50 on silo; "
                                      "factorisations 0.67 on rock pile, 0.67 on log tower and 0.67 on silo.\n"), said)

    def test_options_and_failures(self):
        self.check_refused((("--rounds", 0), "--rounds is '0'"), (("--steps", 0), "--steps is '0'"))
        self.assertIn("exit code 3", self.run_it("--steps", 5, code=1, stand_in_code=3).stderr)
        self.assertFalse((self.directory / "out").exists())


if __name__ == "__main__":
    unittest.main()
