"""scripts/report_runs with a stand-in for the program: what it runs, what it keeps, how it ends."""
import os
import pathlib
import tempfile
import unittest

from report_data import OF_TRADEOFF
from synthetic import PROGRAM, ROOT, SCRIPTS, run_script

from cleave_scripts.figures import data, style
from cleave_scripts.figures.registry import FIGURES
from cleave_scripts.results.paper import REFINERS, SCENES

STAND_IN = f"""#!/usr/bin/python3
import os, sys
sys.path.insert(0, {str(ROOT / "tests" / "scripts")!r})
import stand_in_key
import stand_in_sweep
stand_in_sweep.answer()
from report_data import manifest, rows_of, whole_system
from synthetic import asked_partitioners, asked_refiners, write_manifest, write_steps
arguments = [argument for argument in sys.argv[2:] if argument not in ("--record-motion", "--force")]
given = dict(zip((name[2:] for name in arguments[::2]), arguments[1::2]))
with open(os.environ["STAND_IN_LOG"], "a") as log:
    log.write(" ".join(sys.argv[1:]) + "\\n")
if os.environ.get("STAND_IN_STOP") == given.get("sweeps", "-"):
    sys.exit(130)
rows = []
for solver in given["solver"].split(","):
    changes = dict(solver=solver, threads=int(given["threads"]), bodies=int(given.get("bodies", 200)),
                   repeat_count=int(given["repeats"]))
    if "kernel" in given:
        changes |= dict(solver="pivot:" + given["kernel"], kernel=given["kernel"])
    if solver.startswith("schur"):
        rows += rows_of(given["scene"], asked_partitioners(given["partitioner"]),
                        asked_refiners(given["refiner"]), (9, 19), **changes)
    else:
        rows += rows_of(given["scene"], ("-",), ("-",), (9, 19), **changes)
write_steps(given["out"], rows)
if "--record-motion" in sys.argv:
    open(given["out"] + "/motion.h5", "w").close()
entries, key = manifest(given.pop("scene"), **given), stand_in_key.manifest_entries()
entries["options"] |= key.pop("options")
write_manifest(given["out"], **dict(entries | key, argv=sys.argv,
               utc_end="2026-01-01T00:00:00Z", result={{"rows": len(rows), "rows_ok": len(rows)}}))
sys.exit(2 if given["solver"] == "pgs" else 0)
"""


class ReportRunsTest(unittest.TestCase):

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.directory = pathlib.Path(scratch.name)
        self.log = self.directory / "log"
        self.program = self.directory / "cleave"
        self.program.write_text(STAND_IN)
        self.program.chmod(0o755)
        self.environment = dict(os.environ, CLEAVE_PROGRAM=str(self.program), STAND_IN_REAL=PROGRAM, STAND_IN_LOG=str(self.log))

    def runs(self, *arguments, code=0, stop=""):
        """(lines of the program's calls, what was said)"""
        self.log.write_text("")
        environment = self.environment | {"STAND_IN_STOP": stop}
        result = run_script("report_runs", "--out", self.directory / "out", *arguments, env=environment)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return self.log.read_text().splitlines(), result.stderr

    def test_the_report_has_everything_it_draws_but_the_ladder_and_the_verdict_map(self):
        calls, _ = self.runs("--steps", 100)
        for scene in SCENES:
            self.assertEqual(sum(f"--scene {scene} " in call for call in calls) >= 2, True, scene)
        motion = [call for call in calls if "--record-motion" in call]
        self.assertEqual(len(motion), 3)
        self.assertTrue(all("--measure-every 2 " in call and "--repeats 1 " in call for call in motion))
        every, = [call for call in calls if "--measure-every 1 " in call]
        for words in ("--scene log_tower", "--partitioner mindp ", f"--refiner {','.join(REFINERS)}"):
            self.assertIn(words, every)
        # scripts/reproduce ends with a check that made-up rows need not pass.
        run_script("reproduce", "--out", self.directory / "out", "--steps", 100, env=self.environment)
        loaded = data.load(self.directory / "out", "schur")
        self.assertEqual({scene: blocks[0].experiment.name for scene, blocks in loaded.main.items()},
                         {scene: f"paper/{scene}" for scene in SCENES})
        for figure in FIGURES:
            if figure.name not in ("ladder", "verdict_map", *OF_TRADEOFF):
                picture, caption = figure.draw(loaded)
                style.pyplot.close(picture)
                self.assertNotIn("No data", caption, figure.name)

    def test_complete_runs_are_kept_and_an_interruption_is_passed_on(self):
        first, _ = self.runs("--steps", 50, code=130, stop="100")
        self.assertIn("--sweeps 100", first[-1])
        second, _ = self.runs("--steps", 50)
        self.assertIn("--sweeps 100", second[0])
        self.assertEqual(len(set(first + second)), len(first) - 1 + len(second))
        self.assertEqual(self.runs("--steps", 50)[0], [])

    def test_bad_options_are_one_line_before_anything_runs(self):
        for arguments, words in ((["--steps",
                                   "0"], "--steps is '0'"), (["--fast"], "unknown option '--fast'"),
                                 (["--seed"], "--seed needs a value")):
            calls, said = self.runs(*arguments, code=1)
            self.assertEqual((calls, len(said.splitlines())), ([], 1))
            self.assertIn(words, said)


class ReadmeFiguresTest(unittest.TestCase):

    def test_what_is_missing_is_named(self):
        with tempfile.TemporaryDirectory() as directory:
            out = pathlib.Path(directory) / "out"
            result = run_script("readme_figures", directory, "--out", out)
            self.assertEqual((result.returncode, len(result.stderr.splitlines())), (1, 1), result.stderr)
            self.assertIn("figure2.png is missing", result.stderr)

    def test_stored_pictures_are_not_what_it_writes_unless_it_is_told(self):
        told = " ".join(run_script("readme_figures", "--help").stdout.split())
        self.assertRegex(told, r"\(default \S+/out/readme_figures\)")

    def test_the_pictures_of_the_readme_are_small(self):
        pictures = sorted((SCRIPTS.parent / "results" / "figures").glob("*.png"))
        self.assertEqual([path.stem for path in pictures], ["figure2", "figure3", "film_strip"])
        for path in pictures:
            self.assertLess(path.stat().st_size, 300_000, path)


if __name__ == "__main__":
    unittest.main()
