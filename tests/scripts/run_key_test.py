"""What decides that results are there already: scripts/cleave_scripts/results/run_key.py, seen through scripts/reproduce."""
import json
import os
import pathlib
import tempfile
import unittest
import unittest.mock

from reproduce_test import STAND_IN
from stand_in import StandInCase
from synthetic import ROOT

from cleave_scripts.measurements import runs
from cleave_scripts.results import run_key
from cleave_scripts.results.errors import ResultError
from cleave_scripts.results.kept import RunDirectories

KEY = {"run_id": "1", "threads": 2, "git_hash": "a" * 40, "git_dirty": "false", "flags": "-O3", "build_type": "Release",
       "cpu_model": "C", "cores": 2}


class DifferenceTest(unittest.TestCase):

    def test_equal_keys_are_kept_and_every_part_of_the_key_counts(self):
        self.assertIsNone(run_key.difference(KEY, KEY))
        for name, value, words in (("run_id", "2", "another experiment: run_id 1, wanted 2"),
                                   ("threads", 1, "threads 2, wanted 1"), ("git_hash", "b" * 40, "commit aaaaaaaaaa"),
                                   ("flags", "-O2", "built otherwise: flags -O3, here -O2"),
                                   ("build_type", "Debug", "built otherwise: build_type Release, here Debug"),
                                   ("cpu_model", "D", "another machine: cpu_model C, here D"),
                                   ("cores", 4, "another machine: cores 2, here 4")):
            self.assertIn(words, run_key.difference(KEY, KEY | {name: value}), name)

    def test_results_of_a_dirty_or_unknown_build_equal_nothing(self):
        for state in ("true", "unknown"):
            dirty = KEY | {"git_dirty": state}
            self.assertIn("never kept", run_key.difference(dirty, dirty))
            self.assertIn("local changes", run_key.difference(dirty, KEY))

    def test_a_manifest_without_a_key_is_no_match(self):
        self.assertIsNotNone(run_key.difference(run_key.manifest_key({}), KEY))

    def test_a_program_that_gives_no_key(self):
        with self.assertRaisesRegex(ResultError, "exit code 1"):
            run_key.program_key("/bin/false", ("run",))

    def test_a_program_that_does_not_say_how_it_was_built(self):
        with tempfile.TemporaryDirectory() as scratch:
            program = pathlib.Path(scratch) / "cleave"
            program.write_text(f"#!/bin/sh\necho '{json.dumps({name: value for name, value in KEY.items() if name != 'flags'})}'\n")
            program.chmod(0o755)
            with self.assertRaisesRegex(ResultError, "does not say flags"):
                run_key.program_key(program, ("run",))


class KeepTest(StandInCase):
    script, stand_in = "reproduce", STAND_IN

    def reproduce(self, **changes):
        """How often the program ran, and what was said."""
        with unittest.mock.patch.dict(os.environ, STAND_IN_KEY=json.dumps(changes)):
            said = self.run_it("--scene", "rock_pile", "--steps", 20).stderr
        return len(self.calls()), said

    def test_another_build_or_machine_runs_anew_and_says_why(self):
        self.assertEqual(self.reproduce()[0], 1)
        self.assertEqual(self.reproduce()[0], 0)
        for change, words in (({"git_hash": "f" * 40}, "made by commit 0123456789, this is ffffffffff"),
                              ({"cpu_model": "Other CPU"}, "another machine: cpu_model Some CPU, here Other CPU"),
                              ({"cores": 8}, "another machine: cores 2, here 8"),
                              ({"flags": "-O0"}, "built otherwise: flags -O3 -march=x86-64-v3, here -O0"),
                              ({"build_type": "Debug"}, "built otherwise: build_type RelWithDebInfo, here Debug")):
            with self.subTest(change):
                runs, said = self.reproduce(**change)
                self.assertEqual(runs, 1)
                self.assertIn(words, said)
                self.reproduce()

    def test_another_command_is_refused_on_the_same_build_and_machine_alone(self):
        self.reproduce()
        with self.assertRaisesRegex(ResultError, "holds the results of: run --scene rock_pile"):
            self.find("--steps", "7")
        for change, words in (({"git_hash": "f" * 40}, "this is ffffffffff"), ({"flags": "-O0"}, "flags"),
                              ({"cores": 8}, "another machine")):
            with unittest.mock.patch.dict(os.environ, STAND_IN_KEY=json.dumps(change)):
                result, said = self.find("--steps", "7")
            self.assertIsNone(result)
            self.assertIn(words, said)

    def find(self, *options):
        """What is kept of a run of reproduce by the arguments of another."""
        settings = runs.Settings(steps=20, measure_every=2, repeats=3, threads=2, seed=1)
        run = runs.Run(self.directory / "out" / "rock_pile", "label", "what", ("--scene", "rock_pile", *options), settings)
        store = RunDirectories()
        store.open(self.program, [run], force=True)
        return store.find(run)

    def test_results_of_a_dirty_build_are_never_kept(self):
        for _ in range(2):
            self.assertEqual(self.reproduce(git_dirty="true")[0], 1)
        runs, said = self.reproduce()
        self.assertEqual(runs, 1)
        self.assertIn("local changes", said)

    def test_motion_that_is_asked_for_has_to_be_there(self):
        self.reproduce()
        self.assertEqual(self.find("--record-motion"), (None, ""))


class VersionTest(unittest.TestCase):

    def test_the_sources_have_one_version(self):
        version = f"VERSION {citation_version()}"
        self.assertIn(version, (ROOT / "CMakeLists.txt").read_text())


def citation_version():
    lines = (ROOT / "CITATION.cff").read_text().splitlines()
    return next(line.split()[1] for line in lines if line.startswith("version: "))


if __name__ == "__main__":
    unittest.main()
