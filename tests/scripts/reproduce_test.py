"""scripts/reproduce with a stand-in for the program that writes made-up results."""
import json
import unittest

from stand_in import StandInCase
from synthetic import ROOT

from cleave_scripts.results.paper import ASKED_PARTITIONERS, ASKED_REFINERS

STAND_IN = f"""#!/usr/bin/python3
import os, pathlib, sys
sys.path.insert(0, {str(ROOT / "tests" / "scripts")!r})
import stand_in_key
stand_in_key.answer()
from synthetic import matrix, write_manifest, write_steps
given = dict(zip(sys.argv[2::2], sys.argv[3::2]))
with open(os.environ["STAND_IN_LOG"], "a") as log:
    log.write(" ".join(sys.argv[1:]) + "\\n")
code = int(os.environ.get("STAND_IN_CODE", 0))
if code not in (0, 2):
    sys.exit(code)
every = int(given["--measure-every"])
rows = matrix(given["--scene"], range(every - 1, int(given["--steps"]), every))
if code == 2:
    rows[0]["status"] = "not_converged"
write_steps(given["--out"], rows)
write_manifest(given["--out"], **stand_in_key.manifest_entries(), state="complete", argv=sys.argv, utc_end="2026-01-01T00:00:00Z",
               result={{"rows": len(rows), "rows_ok": sum(row["status"] == "ok" for row in rows)}})
sys.exit(code)
"""


class ReproduceTest(StandInCase):
    script, stand_in = "reproduce", STAND_IN

    def test_quick_matrix_runs_every_scene_and_prints_the_table_and_the_check(self):
        result = self.run_it()
        calls = self.calls()
        self.assertEqual(
            calls[1], f"run --scene log_tower --partitioner {ASKED_PARTITIONERS} --refiner {ASKED_REFINERS} "
            "--solver schur --steps 500 "
            f"--measure-every 50 --repeats 3 --threads 2 --seed 1 --out {self.directory}/out/log_tower "
            "--force")
        self.assertEqual([call.split()[2] for call in calls],
                         ["chain_drop", "log_tower", "rock_pile", "large_rock_pile"])
        self.assertIn("Large Rock Pile: 10 measured steps", result.stdout)
        self.assertIn("600 rows checked", result.stdout)
        self.assertNotIn("FAIL", result.stdout)

    def test_options_are_passed_on(self):
        self.run_it("--scene", "log_tower,chain_drop", "--steps", 25, "--repeats", 1, "--threads", 4,
                       "--seed", 0)
        calls = self.calls()
        self.assertEqual([call.split()[2] for call in calls], ["log_tower", "chain_drop"])
        self.assertIn("--steps 25 --measure-every 2 --repeats 1 --threads 4 --seed 0", calls[0])
        self.run_it("--scene", "rock_pile", "--full", "--steps", 20)
        self.assertIn("--steps 20 --measure-every 1 ", self.calls()[0])

    def test_fewer_steps_than_ten_are_checked_as_such(self):
        self.assertIn("enough measured steps", self.run_it("--scene", "rock_pile", "--steps", 4).stdout)
        self.run_it("--scene", "log_tower", "--steps", 4, "--measure-every", 5, code=1)

    def test_a_complete_scene_is_kept_until_forced(self):
        arguments = ("--scene", "rock_pile")
        self.run_it(*arguments)
        self.calls()
        result = self.run_it(*arguments)
        self.assertEqual(self.calls(), [])
        self.assertIn("rock_pile is kept: 150 of 150 rows ok", result.stderr)
        self.assertIn("Rock Pile: 10 measured steps", result.stdout)
        self.run_it(*arguments, "--force")
        self.assertEqual(len(self.calls()), 1)

    def test_an_incomplete_scene_is_run_again(self):
        self.run_it("--scene", "rock_pile")
        path = self.directory / "out" / "rock_pile" / "manifest.json"
        complete = path.read_text()
        for damage in (lambda: path.write_text(json.dumps(dict(json.loads(complete), state="running"))),
                       lambda: path.write_text(complete[:20]), path.unlink,
                       (path.parent / "steps.csv").unlink):
            self.calls()
            damage()
            self.run_it("--scene", "rock_pile")
            self.assertEqual(len(self.calls()), 1)

    def test_complete_results_of_other_options_are_not_overwritten(self):
        self.run_it("--scene", "rock_pile")
        self.calls()
        result = self.run_it("--scene", "rock_pile", "--steps", 20, code=1)
        self.assertEqual(self.calls(), [])
        self.assertIn("--steps 500", result.stderr)
        self.assertIn("--force", result.stderr)
        self.run_it("--scene", "rock_pile", "--steps", 20, "--force")

    def test_failed_cells_end_with_two_and_are_counted_also_when_kept(self):
        for _ in range(2):
            result = self.run_it("--scene", "rock_pile", code=2, stand_in_code=2)
            self.assertIn("1 failed row (status not ok)", result.stdout)
            self.assertIn("FAIL  every row has status ok", result.stdout)
        self.assertEqual(len(self.calls()), 1)

    def test_other_failures_stop_at_once(self):
        for stand_in_code, code, words in ((1, 1, "exit code 1 on chain_drop"), (130, 130, "interrupted"),
                                           (139, 1, "exit code 139 on chain_drop")):
            result = self.run_it(code=code, stand_in_code=stand_in_code)
            self.assertIn(words, result.stderr)
            self.assertEqual((len(self.calls()), result.stdout), (1, ""))

    def test_bad_options_are_one_line_before_anything_runs(self):
        self.check_refused((["--steps", "0"], "--steps is '0'"), (["--steps", "ten"], "whole number"),
                                 (["--threads", "-1"], "--threads is '-1'"), (["--seed",
                                                                               "x"], "--seed is 'x'"),
                                 (["--scene", "rocks"], "--scene has 'rocks', expected one of chain_drop,log_tower"),
                                 (["--scene",
                                   ""], "--scene has '', expected one of"), (["--steps"], "--steps needs a value"),
                                 (["--fast"], "unknown option '--fast'"), (["rock_pile"], "'rock_pile'"))
        self.assertFalse((self.directory / "out").exists())

    def test_a_program_that_cannot_be_run(self):
        self.program.chmod(0o644)
        self.assertIn("CLEAVE_PROGRAM", self.run_it(code=1).stderr)


if __name__ == "__main__":
    unittest.main()
