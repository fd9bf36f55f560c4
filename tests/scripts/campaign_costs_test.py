"""scripts/campaign_costs: what is made of its rows, and the command with the program itself on a small campaign."""
import csv
import pathlib
import tempfile
import unittest

from synthetic import PROGRAM, run_script, write_manifest, write_steps

from cleave_scripts.measurements import campaign_costs

INDEX = "cell,number,round,status,reason,log,arguments,label,run_s,process_s\n"


class PaperTest(unittest.TestCase):

    def test_every_repeat_counts_as_a_solve_and_earlier_cells_do_not(self):
        with tempfile.TemporaryDirectory() as scratch:
            directory = pathlib.Path(scratch)
            for cell in "ab":
                write_steps(directory / "cells" / cell, [{"repeat_count": 3, "t_s_ms": 100, "t_pr_ms": 1},
                                                         {"repeat_count": 2, "t_s_ms": 10, "t_pr_ms": -1}])
                write_manifest(directory / "cells" / cell)
            (directory / "index.csv").write_text(INDEX + "a,1,1,ok,-,-,--scene=x,-,0.4,0.5\nb,0,1,ok,-,-,--scene=x,-,7,8\n")
            rows = campaign_costs.times_of(directory)
        self.assertEqual({row["what"]: round(row["seconds"], 9) for row in rows},
                         {"paper_processes": 0.5, "paper_runs": 0.4, "paper_solves": 0.323})
        rows += [{"what": what, "cells": 9, "round": 1, "seconds": 2, "peak_memory_mb": 50} for what in campaign_costs.WORDS]
        self.assertIn("35.4 % of its processes' time", list(campaign_costs.lines_of(rows))[-1])


class CommandTest(unittest.TestCase):

    def test_every_command_is_timed_in_every_round(self):
        with tempfile.TemporaryDirectory() as scratch:
            done = run_script("campaign_costs", "--cells", 5, "--rounds", 2, "--out", scratch, env={"CLEAVE_PROGRAM": PROGRAM})
            self.assertEqual(done.returncode, 0, done.stderr)
            with open(pathlib.Path(scratch) / "campaign_costs.csv", newline="") as file:
                rows = list(csv.DictReader(file))
            with open(pathlib.Path(scratch) / "collected" / "results.csv", newline="") as file:
                self.assertEqual(len(list(csv.DictReader(file))), 5)
            self.assertTrue((pathlib.Path(scratch) / "campaign" / "index.csv").is_file())
        self.assertEqual([(row["what"], row["round"]) for row in rows],
                         [(what, number) for number in "12" for what in campaign_costs.WORDS])
        for row in rows:
            self.assertGreater(float(row["seconds"]), 0)
            self.assertGreater(float(row["peak_memory_mb"]), 1)


if __name__ == "__main__":
    unittest.main()
