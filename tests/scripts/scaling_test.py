"""scripts/scaling with a stand-in for the program, and Figure 4 from what it leaves."""
import unittest

from stand_in import StandInCase
from synthetic import ROOT

from cleave_scripts.figures import data, times_by_size
from cleave_scripts.results.paper import ASKED_REFINERS

STAND_IN = f"""#!/usr/bin/python3
import os, sys
sys.path.insert(0, {str(ROOT / "tests" / "scripts")!r})
import stand_in_key
stand_in_key.answer()
from report_data import manifest, rows_of
from synthetic import write_manifest, write_steps
given = dict(zip(sys.argv[2::2], sys.argv[3::2]))
with open(os.environ["STAND_IN_LOG"], "a") as log:
    log.write(" ".join(sys.argv[1:]) + "\\n")
code, size = int(os.environ.get("STAND_IN_CODE", 0)), int(given["--bodies"])
every = int(given["--measure-every"])
if code not in (0, 2):
    sys.exit(code)
rows = rows_of(given["--scene"], given["--partitioner"].split(","),
               steps=range(every - 1, int(given["--steps"]), every), bodies=size, t_s_ms=size ** 1.5)
write_steps(given["--out"], rows)
entries, key = manifest("rock_pile", bodies=size), stand_in_key.manifest_entries()
entries["options"] |= key.pop("options")
write_manifest(given["--out"], **dict(entries | key, argv=sys.argv,
               utc_end="2026-01-01T00:00:00Z",
               result={{"rows": len(rows), "rows_ok": len(rows) - (code == 2)}}))
sys.exit(code)
"""


class ScalingTest(StandInCase):
    script, stand_in = "scaling", STAND_IN

    def test_every_size_is_run_once_and_figure_4_finds_the_exponent(self):
        self.run_it("--sizes", "50,100,400", "--steps", 20)
        calls = self.calls()
        self.assertEqual(
            calls[1],
            f"run --scene rock_pile --bodies 100 --partitioner mindp,mix --refiner {ASKED_REFINERS} --solver schur "
            "--steps 20 --measure-every 2 --repeats 3 --threads 2 --seed 1 "
            f"--out {self.directory}/out/scaling/bodies_100 --force")
        self.assertEqual(len(calls), 3)
        groups = times_by_size.sizes(data.load(self.directory / "out", "schur").blocks, "schur")
        self.assertEqual(list(groups), [50, 100, 400])
        means = [part.rows["t_s_ms"].mean() for (part,) in groups.values()]
        self.assertAlmostEqual(times_by_size.fit_power(list(groups), means).exponent, 1.5, 9)
        result = self.run_it("--sizes", "50,100,400", "--steps", 20)
        self.assertEqual(self.calls(), [])
        self.assertEqual(result.stderr.count("is kept: "), 3)
        self.run_it("--sizes", "50", "--steps", 20, "--force")
        self.assertEqual(len(self.calls()), 1)

    def test_results_of_other_options_are_not_overwritten(self):
        self.run_it("--sizes", "50", "--steps", 20)
        self.assertIn("--force", self.run_it("--sizes", "50", "--steps", 40, code=1).stderr)

    def test_what_the_program_ends_with_is_passed_on(self):
        for stand_in_code, code, words, calls in ((2, 2, "", 2), (130, 130, "interrupted", 1),
                                                  (1, 1, "exit code 1 on 50 rocks", 1)):
            result = self.run_it("--sizes", "50,100", "--force", code=code, stand_in_code=stand_in_code)
            self.assertIn(words, result.stderr)
            self.assertEqual(len(self.calls()), calls)

    def test_bad_options_are_one_line_before_anything_runs(self):
        self.check_refused((["--sizes", "50,many"], "--sizes has 'many'"),
                                 (["--sizes",
                                   ""], "--sizes has '', expected a whole number"), (["--steps", "5", "--measure-every",
                                                                    "6"], "--measure-every is '6', expected at most --steps, 5"),
                                 (["--seed", "x"], "--seed is 'x'"), (["--fast"], "unknown option '--fast'"))


if __name__ == "__main__":
    unittest.main()
