"""scripts/scaling with a stand-in for the program, and Figure 4 from what it leaves."""
import unittest

from stand_in import StandInCase
from synthetic import ROOT

from cleave_scripts.figures import data, times_by_size
from cleave_scripts.results.paper import REFINERS

STAND_IN = f"""#!/usr/bin/python3
import os, sys
sys.path.insert(0, {str(ROOT / "tests" / "scripts")!r})
import stand_in_key
import stand_in_sweep
stand_in_sweep.answer()
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

    def cells(self):
        words = [call.split() for call in self.calls()]
        return [dict(zip(call[1::2], call[2::2])) for call in words]

    def test_every_size_is_run_in_rounds_and_figure_4_finds_the_exponent(self):
        self.run_it("--sizes", "50,100,400", "--steps", 20, "--repeats", 2)
        cells = self.cells()
        self.assertEqual([int(cell["--bodies"]) for cell in cells], 2 * [50, 100, 400])
        cells[1].pop("--out")
        self.assertEqual(cells[1], {
            "--scene": "rock_pile", "--bodies": "100", "--partitioner": "mindp,mix", "--refiner": ",".join(REFINERS),
            "--solver": "schur", "--steps": "20", "--measure-every": "2", "--repeats": "1", "--threads": "2", "--seed": "1"})
        groups = times_by_size.sizes(data.load(self.directory / "out", "schur").blocks, "schur")
        self.assertEqual({size: len(rounds) for size, rounds in groups.items()}, {50: 2, 100: 2, 400: 2})
        means = [parts[0].rows["t_s_ms"].mean() for parts in groups.values()]
        self.assertAlmostEqual(times_by_size.fit_power(list(groups), means).exponent, 1.5, 9)
        self.run_it("--sizes", "50,100,400", "--steps", 20, "--repeats", 2)
        self.assertEqual(self.calls(), [])
        self.run_it("--sizes", "50", "--steps", 20, "--repeats", 2, "--force")
        self.assertEqual(len(self.calls()), 2)

    def test_what_the_program_ends_with_is_passed_on(self):
        for stand_in_code, code, words, calls in ((2, 2, "", 2), (130, 130, "interrupted", 1), (1, 2, "", 2)):
            result = self.run_it("--sizes", "50,100", "--repeats", 1, "--force", code=code, stand_in_code=stand_in_code)
            self.assertIn(words, result.stderr)
            self.assertEqual(len(self.calls()), calls)

    def test_what_the_program_refuses_is_told_in_its_words(self):
        result = self.run_it("--sizes", "50", "--partitioner", "mindq", code=1)
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        self.assertIn("--partitioner: 'mindq' is unknown (did you mean 'mindp'?)", result.stderr)
        self.assertEqual(self.calls(), [])
        self.assertFalse((self.directory / "out" / "scaling").exists())

    def test_bad_options_are_one_line_before_anything_runs(self):
        self.check_refused((["--sizes", "50,many"], "--sizes has 'many'"),
                           (["--sizes", ""], "--sizes has '', expected a whole number"),
                           (["--steps", "5", "--measure-every", "6"], "--measure-every is '6', expected at most --steps, 5"),
                           (["--seed", "x"], "--seed is 'x'"), (["--fast"], "unknown option '--fast'"))


if __name__ == "__main__":
    unittest.main()
