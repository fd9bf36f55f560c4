"""scripts/model_savings: what is made of its rows, and the command with a stand-in for the program."""
import collections
import csv
import tomllib
import unittest

from stand_in import NOTES_ITS_CALL, StandInCase
from synthetic import ROOT

from cleave_scripts.measurements.model_savings import CASES, laid_chain, savings, standing_tower

STAND_IN = NOTES_ITS_CALL + """from synthetic import write_steps
write_steps(pathlib.Path(given["--out"]), [
    dict(seed=1, scene=given["--scene"], bodies=9, mu=given.get("--mu", 0.5), step=step, rows=60 * step, model=given["--model"],
         model_rows_left_out=6,
         model_rows_at_rest=3, model_rows_returned=0, model_passes=1, velocity_spread_m_per_s=1e-12, t_s_ms=4, status="ok")
    for step in (0, 1, 2, 299, 300, 3000, 16000)])
"""


def row(model, step, t_s_ms, left_out=0, spread=0.0, rows=100):
    return {"case": "c", "bodies": "9", "mu": "0.5", "model": model, "step": str(step), "rows": str(rows),
            "t_s_ms": str(t_s_ms), "model_rows_left_out": str(left_out), "model_rows_at_rest": "10", "model_rows_returned": "1",
            "velocity_spread_m_per_s": str(spread)}


class SavingsTest(unittest.TestCase):

    def test_ratios_are_of_medians_over_rounds_and_shares_of_all_rows(self):
        rows = [row("full", 1, ms) for ms in (1, 2, 90)] + [row("full", 2, 4)]
        rows += [row("auto", 1, ms, 20, 1e-12) for ms in (0.5, 1, 70)] + [row("auto", 2, 8, 0, 3e-11)]
        found, = savings(rows).values()
        self.assertEqual((found.full_ms, found.ratio, found.least, found.most), (3, 9 / 6, 0.5, 2))
        self.assertEqual((found.left_out, found.at_rest, found.returned), (60 / 400, 0.1, 0.01))
        self.assertEqual(found.largest_difference_m_per_s, 3e-11)

    def test_scenes_and_friction_are_told_apart(self):
        rows = [row("full", 1, 2), row("auto", 1, 2)]
        self.assertEqual(len(savings(rows + [{**line, "mu": "0"} for line in rows])), 2)


class ModelSavingsTest(StandInCase):
    stand_in = STAND_IN
    script = "model_savings"

    def test_every_scene_with_both_models_in_turn(self):
        self.run_it("--steps", 100, "--rounds", 2)
        calls = self.calls()
        self.assertEqual(len(calls), 2 * len(CASES) * 2)
        self.assertIn("--measure-every 2 --model full", calls[0])
        self.assertIn("--model auto", calls[1])
        with open(self.directory / "out" / "model_savings.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        at_rest = {"log tower at rest": 3, "chain drop at rest": 1, "chain drop, laid out": 2,
                   "chain drop, heaped": 2}  # steps from the first of the case on
        self.assertEqual(collections.Counter(line["case"] for line in rows),
                         {case: 2 * 2 * at_rest.get(case, 6) for case in CASES})  # the first step has no constraint
        self.assertIn("--steps 600 --measure-every 6", calls[2 * list(CASES).index("log tower at rest")])
        self.assertEqual(len(savings(rows)), len(CASES))
        self.assertEqual({line["round"] for line in rows}, {"1", "2"})

    def test_the_standing_tower_is_the_tower_without_its_events(self):
        tower = tomllib.loads((ROOT / "scenarios" / "files" / "log_tower.toml").read_text())
        self.assertTrue(tower.pop("event"))
        self.assertEqual(tomllib.loads(standing_tower()), tower)

    def test_the_laid_chain_is_the_chain_on_a_floor(self):
        chain = tomllib.loads((ROOT / "scenarios" / "files" / "chain_drop.toml").read_text())
        self.assertEqual(len(chain.pop("plane")), 4)
        for body in chain["body"]:
            body["through_m"] = [[x, y, body["radius_m"]] for x, y, _ in body["through_m"]]
        self.assertEqual(tomllib.loads(laid_chain()), {"ground": {}, **chain})

    def test_options(self):
        self.check_refused((("--rounds", 0), "--rounds is '0'"), (("--steps", 0), "--steps is '0'"))


if __name__ == "__main__":
    unittest.main()
