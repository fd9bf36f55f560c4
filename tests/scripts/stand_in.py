"""Tests of a script with a stand-in for the program, which notes what it was called with."""
import os
import pathlib
import tempfile
import unittest

from synthetic import PROGRAM, ROOT, run_script

# What a stand-in begins with: its words, the options given among them, and the note of its call. Asked for its key, it says
# that alone.
NOTES_ITS_CALL = f"""#!/usr/bin/python3
import os, pathlib, sys
sys.path.insert(0, {str(ROOT / "tests" / "scripts")!r})
import stand_in_key
stand_in_key.answer()
words = sys.argv[1:]
given = dict(zip(words, words[1:]))
with open(os.environ["STAND_IN_LOG"], "a") as log:
    log.write(" ".join(words) + "\\n")
"""


class StandInCase(unittest.TestCase):
    """script: its name in scripts/. stand_in: text of the program that it runs; reads STAND_IN_LOG, STAND_IN_CODE."""
    script = stand_in = None

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.directory = pathlib.Path(scratch.name)
        self.log = self.directory / "log"
        self.log.touch()
        self.program = self.directory / "cleave"
        self.program.write_text(self.stand_in)
        self.program.chmod(0o755)

    def run_it(self, *arguments, code=0, stand_in_code=0):
        environment = dict(os.environ,
                           CLEAVE_PROGRAM=str(self.program),
                           STAND_IN_REAL=PROGRAM,
                           STAND_IN_LOG=str(self.log),
                           STAND_IN_CODE=str(stand_in_code))
        result = run_script(self.script, "--out", self.directory / "out", *arguments, env=environment)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result

    def check_refused(self, *cases):
        """Each case: (arguments, words). One line with these words, and nothing was run."""
        for arguments, words in cases:
            with self.subTest(arguments):
                result = self.run_it(*arguments, code=1)
                self.assertIn(words, result.stderr)
                self.assertEqual(len(result.stderr.splitlines()), 1)
        self.assertEqual(self.calls(), [])

    def calls(self):
        lines = self.log.read_text().splitlines()
        self.log.write_text("")
        return lines
