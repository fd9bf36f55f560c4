"""scripts/reproduce with a stand-in for the program that writes made-up results."""
import pathlib
import unittest

from stand_in import StandInCase
from synthetic import ROOT

from cleave_scripts.results.paper import PARTITIONERS, REFINERS

STAND_IN = f"""#!/usr/bin/python3
import os, pathlib, sys
sys.path.insert(0, {str(ROOT / "tests" / "scripts")!r})
import stand_in_key
import stand_in_sweep
stand_in_sweep.answer()
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
write_manifest(given["--out"], **stand_in_key.manifest_entries(), state="complete", argv=sys.argv,
               utc_end="2026-01-01T00:00:00Z",
               result={{"rows": len(rows), "rows_ok": sum(row["status"] == "ok" for row in rows)}})
sys.exit(code)
"""


class ReproduceTest(StandInCase):
    script, stand_in = "reproduce", STAND_IN

    def cells(self):
        """Options of the runs, in order."""
        words = [call.split() for call in self.calls()]
        return [dict(zip(call[1::2], call[2::2])) for call in words]

    def test_quick_matrix_runs_every_scene_and_prints_the_table_and_the_check(self):
        result = self.run_it()
        cells = self.cells()
        out = cells[1].pop("--out")
        self.assertEqual(cells[1], {
            "--scene": "log_tower", "--partitioner": ",".join(PARTITIONERS), "--refiner": ",".join(REFINERS),
            "--solver": "schur", "--steps": "500", "--measure-every": "50", "--repeats": "3", "--threads": "2", "--seed": "1"})
        self.assertEqual(pathlib.Path(out).parent, self.directory / "out" / "paper" / "cells")
        self.assertEqual([cell["--scene"] for cell in cells], ["chain_drop", "log_tower", "rock_pile", "large_rock_pile"])
        self.assertIn("Large Rock Pile: 10 measured steps", result.stdout)
        self.assertIn("600 rows checked", result.stdout)
        self.assertNotIn("FAIL", result.stdout)

    def test_options_are_passed_on(self):
        self.run_it("--scene", "log_tower,chain_drop", "--steps", 25, "--repeats", 1, "--threads", 4,
                       "--seed", 2**64 - 1)
        first, second = self.cells()
        self.assertEqual((first["--scene"], second["--scene"]), ("log_tower", "chain_drop"))
        for name, value in (("steps", 25), ("measure-every", 2), ("repeats", 1), ("threads", 4), ("seed", 2**64 - 1)):
            self.assertEqual(first[f"--{name}"], str(value))
        self.run_it("--scene", "rock_pile", "--full", "--steps", 20)
        cell, = self.cells()
        self.assertEqual((cell["--steps"], cell["--measure-every"]), ("20", "1"))

    def test_fewer_steps_than_ten_are_checked_as_such(self):
        self.assertIn("enough measured steps", self.run_it("--scene", "rock_pile", "--steps", 4).stdout)
        self.run_it("--scene", "log_tower", "--steps", 4, "--measure-every", 5, code=1)

    def test_what_is_done_is_kept_until_forced(self):
        self.run_it("--scene", "rock_pile")
        self.calls()
        self.assertIn("Rock Pile: 10 measured steps", self.run_it("--scene", "rock_pile").stdout)
        self.assertEqual(self.calls(), [])
        self.run_it("--scene", "rock_pile", "--force")
        self.assertEqual(len(self.calls()), 1)

    def test_the_table_is_of_what_was_asked_last(self):
        self.run_it("--scene", "rock_pile")
        result = self.run_it("--scene", "rock_pile", "--steps", 20)
        self.assertIn("Rock Pile: 10 measured steps", result.stdout)
        self.assertIn("150 rows checked", result.stdout)
        self.assertEqual(len(self.calls()), 2)

    def test_failed_cells_end_with_two_and_are_counted(self):
        result = self.run_it("--scene", "rock_pile", code=2, stand_in_code=2)
        self.assertIn("1 failed row (status not ok)", result.stdout)
        self.assertIn("FAIL  every row has status ok", result.stdout)

    def test_an_interruption_says_how_to_go_on(self):
        result = self.run_it(code=130, stand_in_code=130)
        self.assertIn("interrupted; the same command goes on", result.stderr)
        self.assertEqual((len(self.calls()), result.stdout), (1, ""))

    def test_a_scene_whose_process_fails_does_not_stop_the_others(self):
        self.run_it(code=1, stand_in_code=139)
        self.assertEqual(len(self.calls()), 4)

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
