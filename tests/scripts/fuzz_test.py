"""scripts/fuzz with stand-ins for the programs of libFuzzer."""
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest
import unittest.mock

from synthetic import ROOT, SCRIPTS

from cleave_scripts.measurements import fuzzing
from cleave_scripts.results.errors import ResultError

# Prints what libFuzzer prints, and what FAKE says: a finding, a failure of its own, or nothing.
PROGRAM = """#!/usr/bin/python3
import os, pathlib, subprocess, sys
folder = pathlib.Path([word for word in sys.argv if word.startswith("-artifact_prefix=")][0].split("=")[1])
print("INFO: Loaded 1 modules   (5000 inline 8-bit counters): 5000")
print("#100 DONE   cov: 321 ft: 400 corp: 12/345b lim: 4096 exec/s: 10 rss: 40Mb")
name, fake = pathlib.Path(sys.argv[0]).name, os.environ.get("FAKE", "")
if fake == "finding " + name:
    (folder / "crash-1").write_text("x")
    print(f"artifact_prefix='{folder}/'; Test unit written to {folder}/crash-1")
if fake == "commit":
    subprocess.run(["git", "commit", "--quiet", "--allow-empty", "--message=later"], check=True)
print("stat::number_of_executed_units: 1234")
sys.exit({"": 0, "finding " + name: 77, "failure " + name: 1}.get(fake, 0))
"""
# In place of scripts/setup: PROGRAM under the names of all targets.
SETUP = f"""#!/usr/bin/python3
import pathlib
folder = pathlib.Path(__file__).parents[1] / "build" / "fuzz" / "tests" / "fuzz"
folder.mkdir(parents=True)
for name in {fuzzing.TARGETS}:
    (folder / ("fuzz_" + name)).write_text({PROGRAM!r})
    (folder / ("fuzz_" + name)).chmod(0o755)
"""


class FuzzTest(unittest.TestCase):

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.directory = pathlib.Path(scratch.name)
        self.out = self.directory / "out"
        for name in fuzzing.TARGETS:
            program = self.directory / f"fuzz_{name}"
            program.write_text(PROGRAM)
            program.chmod(0o755)

    def fuzz(self, *arguments, fake="", programs=None, scripts=SCRIPTS, **more):
        environment = {**os.environ, "CLEAVE_FUZZ_PROGRAMS": str(programs or self.directory), "FAKE": fake, **more}
        return subprocess.run([scripts / "fuzz", "--out", self.out, *arguments], capture_output=True, text=True,
                              timeout=60, check=False, env=environment)

    def row(self, result, name):
        row, = [line for line in result.stdout.splitlines() if line.startswith(f"| {name} |")]
        return row

    def test_every_target_is_counted_on_the_page(self):
        page = self.directory / "page.md"
        result = self.fuzz("--page", page)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stdout, page.read_text())
        self.assertEqual(result.stdout, (self.out / "README.md").read_text())
        self.assertIn(": 0 findings.", result.stdout)
        for name in fuzzing.TARGETS:
            self.assertIn("| 0 | 1234 | 321 | 5000 | 12 | 0 |", self.row(result, name))

    def test_a_finding_is_kept_and_told(self):
        result = self.fuzz("--target", "csv,scene", fake="finding fuzz_scene")
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertIn("1 finding.", result.stdout)
        self.assertIn("| 0 | 1234 | 321 | 5000 | 12 | 0 |", self.row(result, "csv"))
        self.assertIn("| 0 | 2468 | 321 | 5000 | 12 | 1 |", self.row(result, "scene"))  # the same again ended it
        self.assertNotIn("| options |", result.stdout)
        self.assertEqual([file.name for file in (self.out / "findings" / "scene").iterdir()], ["crash-1"])

    def test_targets_that_ran_apart_stand_on_one_page(self):
        self.assertEqual(self.fuzz("--target", "scene", fake="finding fuzz_scene").returncode, 3)
        result = self.fuzz("--target", "csv")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("1 finding.", result.stdout)
        self.assertEqual([self.row(result, name)[-4:] for name in ("csv", "scene")], [" 0 |", " 1 |"])
        self.assertIn("0 findings.", self.fuzz("--target", "scene").stdout)

    def test_of_programs_that_are_given_nobody_knows_the_commit(self):
        result = self.fuzz()
        self.assertEqual(result.returncode, 0, result.stderr)
        for name in fuzzing.TARGETS:
            self.assertIn("| unknown |", self.row(result, name))

    def test_the_page_names_the_commit_from_before_the_run(self):
        scripts = self.directory / "scripts"
        shutil.copytree(SCRIPTS, scripts, ignore=shutil.ignore_patterns("__pycache__", "node_modules"))
        (scripts / "setup").write_text(SETUP)
        repository = {"GIT_DIR": str(self.directory / ".git"), "GIT_WORK_TREE": str(self.directory)}
        repository |= {f"GIT_{who}_{what}": "x" for who in ("AUTHOR", "COMMITTER") for what in ("NAME", "EMAIL")}

        def git(*words):
            return subprocess.run(["git", *words], capture_output=True, text=True, check=True,
                                  env={**os.environ, **repository}).stdout

        git("init")
        git("commit", "--allow-empty", "--message=first")
        (self.directory / ".git" / "info" / "exclude").write_text("*")
        result = self.fuzz(fake="commit", scripts=scripts, CLEAVE_FUZZ_PROGRAMS="", **repository)
        self.assertEqual(result.returncode, 0, result.stderr)
        first = git("rev-list", "--max-parents=0", "HEAD").strip()
        self.assertNotEqual(first, git("rev-parse", "HEAD").strip())
        for name in fuzzing.TARGETS:
            self.assertIn(f"| {first[:10]} |", self.row(result, name))

    def minimise(self, copy=fuzzing.write_bytes):
        """Names and contents of a corpus that was made as small as `new` and `both`."""
        corpus = self.directory / "tests" / "corpus" / "csv"
        corpus.mkdir(parents=True, exist_ok=True)
        for name in ("old", "both", "finding-1"):
            (corpus / name).write_text(name)

        def merge(words, _):
            for name in ("both", "new"):
                (words[-3] / name).write_text(name)
            return 0

        with unittest.mock.patch.multiple(fuzzing, SOURCES=self.directory / "tests", run=merge, write_bytes=copy):
            try:
                fuzzing.minimise(self.directory, "csv", self.out)
            finally:
                self.corpus = {file.name: file.read_text() for file in corpus.iterdir()}

    def test_the_corpus_is_made_smaller_when_all_that_is_new_is_there(self):

        def full_disk(*_):
            raise ResultError("No space left on device")

        with self.assertRaises(ResultError):
            self.minimise(full_disk)
        self.assertLessEqual({"old", "both", "finding-1"}, set(self.corpus))
        self.minimise()
        self.assertEqual(self.corpus, {name: name for name in ("both", "new", "finding-1")})

    def test_a_program_that_fails_by_itself_is_no_finding(self):
        result = self.fuzz(fake="failure fuzz_manifest")
        self.assertEqual((result.returncode, result.stdout), (1, ""))
        self.assertIn("fuzz_manifest stopped with exit code 1", result.stderr.splitlines()[-1])

    def test_bad_input(self):
        for arguments in (["--target", "nothing"], ["--minutes", "0"], ["--nope"]):
            result = self.fuzz(*arguments)
            self.assertEqual((result.returncode, result.stdout), (1, ""), arguments)
            self.assertFalse(self.out.exists())
        self.assertIn("CLEAVE_FUZZ_PROGRAMS", self.fuzz(programs=self.directory / "none").stderr)

    def test_the_script_and_the_sources_name_the_same_targets(self):
        sources = ROOT / "tests" / "fuzz"
        listed = (sources / "CMakeLists.txt").read_text().split("foreach(TARGET ")[1].split(")")[0].split()
        rows = re.findall(r'\{"(\w+)", read_', (sources / "targets.cpp").read_text())
        folders = sorted(folder.name for folder in (sources / "corpus").iterdir())
        self.assertEqual(sorted(fuzzing.TARGETS), folders)
        self.assertEqual(listed, list(fuzzing.TARGETS))
        self.assertEqual(rows, list(fuzzing.TARGETS))


if __name__ == "__main__":
    unittest.main()
