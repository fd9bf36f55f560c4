"""scripts/extremes with a stand-in for the program, and the table of what it leaves."""
import pathlib
import unittest

from stand_in import StandInCase
from synthetic import ROOT

# Only the columns and fields that the scripts look at: there are many runs.
STAND_IN = f"""#!/usr/bin/python3
import json, os, pathlib, sys
sys.path.insert(0, {str(ROOT / "tests" / "scripts")!r})
import stand_in_key
import stand_in_sweep
stand_in_sweep.answer()
given = dict(zip(sys.argv[2::2], sys.argv[3::2]))
with open(os.environ["STAND_IN_LOG"], "a") as log:
    log.write(" ".join(sys.argv[1:]) + "\\n")
code = int(os.environ.get("STAND_IN_CODE", 0))
if code not in (0, 2) and code < 1000:
    sys.exit(code)
out, rows = pathlib.Path(given["--out"]), int(given["--steps"]) // int(given["--measure-every"])
out.mkdir(parents=True, exist_ok=True)
row = ("not_converged" if code == 2 else "ok") + f",{{code - 1000 if code >= 1000 else 20}}\\n"
(out / "steps.csv").write_text("status,factorizations\\n" + rows * row)
(out / "manifest.json").write_text(json.dumps({{
    **stand_in_key.manifest_entries(), "state": "complete", "argv": sys.argv, "utc_end": "2026-01-01T00:00:00Z",
    "result": {{"rows": rows, "rows_ok": 0 if code == 2 else rows}}}}))
sys.exit(code if code == 2 else 0)
"""


class ExtremesTest(StandInCase):
    script, stand_in = "extremes", STAND_IN
    QUICK = ("--cfm", "1e-4,0", "--seeds", "7", "--steps", "20")

    def test_every_scene_meets_every_compliance_and_complete_runs_are_kept(self):
        result = self.run_it(*self.QUICK)
        calls = self.calls()
        self.assertEqual(len(calls), 2 * 10)
        found = [dict(zip(call.split()[1::2], call.split()[2::2])) for call in calls]
        place = [cell.pop("--out") for cell in found][0]
        self.assertEqual(pathlib.Path(place).parent, self.directory / "out" / "campaign" / "cells")
        self.assertIn({"--scene": "rock_pile", "--mass": "1,1000000", "--cfm": "0", "--solver": "interior-point:monolithic",
                       "--steps": "20", "--measure-every": "1", "--repeats": "1", "--threads": "1", "--seed": "7"}, found)
        self.assertIn("| 1e6 | mixed_pile | ", result.stdout)
        self.assertEqual(result.stdout.count("20 / 20"), 2 * 10)
        self.assertEqual(self.run_it(*self.QUICK).stdout, result.stdout)
        self.assertEqual(self.calls(), [])

    def test_too_many_factorisations_break_it_where_a_number_is_set(self):
        self.assertIn("within the number", self.run_it(*self.QUICK, stand_in_code=1040).stdout)
        self.assertIn("not every step", self.run_it(*self.QUICK, "--force", code=3, stand_in_code=1041).stdout)
        self.run_it("--cfm", "0", "--seeds", "8", "--steps", "20", "--out", self.directory / "rigid", stand_in_code=1099)

    def test_a_step_that_is_not_solved_breaks_it(self):
        result = self.run_it(*self.QUICK, code=3, stand_in_code=2)
        self.assertIn("20 / 20, 20 not solved", result.stdout)

    def test_what_the_program_ends_with_is_passed_on(self):
        self.assertIn("interrupted", self.run_it(*self.QUICK, code=130, stand_in_code=130).stderr)
        self.assertIn("ratio_1_chain_drop_cfm_1e-4_seed_7: crashed", self.run_it(*self.QUICK, code=1, stand_in_code=1).stderr)

    def test_bad_options_are_one_line_before_anything_runs(self):
        self.check_refused((["--cfm", "1e-4,soft"], "--cfm has 'soft'"), (["--seeds", "1,x"], "--seeds has 'x'"),
                                 (["--cfm", ""], "--cfm has '', expected a number"), (["--fast"], "unknown option '--fast'"))


if __name__ == "__main__":
    unittest.main()
