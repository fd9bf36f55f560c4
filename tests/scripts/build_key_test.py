"""What decides that measurements still stand: scripts/cleave_scripts/results/build_key.py."""
import json
import pathlib
import tempfile
import unittest

import synthetic  # noqa: F401  (finds the modules of scripts/)

from cleave_scripts.results.build_key import build_key, difference, version_of
from cleave_scripts.results.errors import ResultError

KEY = {"git_hash": "a" * 40, "git_dirty": "false", "compiler": "G 1", "flags": "-O3", "build_type": "Release",
       "cpu_model": "C", "cores": 2}


class DifferenceTest(unittest.TestCase):

    def test_equal_keys_are_kept_and_every_part_of_the_key_counts(self):
        self.assertIsNone(difference(KEY, KEY))
        for name, value, words in (("git_hash", "b" * 40, "commit aaaaaaaaaa"),
                                   ("compiler", "G 2", "built otherwise: compiler G 1, here G 2"),
                                   ("flags", "-O2", "built otherwise: flags -O3, here -O2"),
                                   ("build_type", "Debug", "built otherwise: build_type Release, here Debug"),
                                   ("cpu_model", "D", "another machine: cpu_model C, here D"),
                                   ("cores", 4, "another machine: cores 2, here 4")):
            self.assertIn(words, difference(KEY, KEY | {name: value}), name)

    def test_results_of_a_dirty_or_unknown_build_equal_nothing(self):
        for state in ("true", "unknown"):
            dirty = KEY | {"git_dirty": state}
            self.assertIn("never kept", difference(dirty, dirty))
            self.assertIn("local changes", difference(dirty, KEY))

    def test_no_key_is_no_match(self):
        self.assertIsNotNone(difference({}, KEY))


class ProgramTest(unittest.TestCase):

    def key_of(self, text, asked=build_key):
        with tempfile.TemporaryDirectory() as scratch:
            program = pathlib.Path(scratch) / "cleave"
            program.write_text(f"#!/bin/sh\n{text}\n")
            program.chmod(0o755)
            return asked(program)

    def test_a_version_is_the_first_line_of_what_a_program_says(self):
        self.assertEqual(self.key_of("echo one; echo two", version_of), "one")
        self.assertEqual(self.key_of("", version_of), "")
        with self.assertRaisesRegex(ResultError, "--version stopped with exit code 4"):
            self.key_of("exit 4", version_of)

    def test_a_program_says_its_build_and_machine(self):
        self.assertEqual(self.key_of(f"echo '{json.dumps(KEY | {'run_id': '1'})}'"), KEY)

    def test_a_program_that_gives_no_key(self):
        with self.assertRaisesRegex(ResultError, "exit code 1"):
            build_key("/bin/false")
        with self.assertRaisesRegex(ResultError, "does not work"):
            self.key_of("echo {")

    def test_a_program_that_does_not_say_how_it_was_built(self):
        less = {name: value for name, value in KEY.items() if name != "flags"}
        with self.assertRaisesRegex(ResultError, "does not say flags"):
            self.key_of(f"echo '{json.dumps(less)}'")


if __name__ == "__main__":
    unittest.main()
