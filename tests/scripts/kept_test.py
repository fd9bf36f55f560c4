"""What is made is noted and kept (scripts/cleave_scripts/results/kept.py), and how a campaign is interrupted."""
import collections
import os
import pathlib
import signal
import subprocess
import tempfile
import time
import unittest

from stand_in import StandInCase
from synthetic import SCRIPTS

from cleave_scripts.results.kept import Journal

KEY = {"git_hash": "a" * 40, "git_dirty": "false", "compiler": "G 1", "flags": "-O3", "build_type": "Release",
       "cpu_model": "C", "cores": 2}
Step = collections.namedtuple("Step", "label arguments")
ONE, TWO = Step("one", ("run", "1")), Step("two", ("run", "2"))


class JournalTest(unittest.TestCase):

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.path = pathlib.Path(scratch.name) / "below" / "steps.jsonl"
        self.runs, self.said = [], []

    def keep_or_run(self, step, journal=None):

        def run(step):
            self.runs.append(step.label)
            return f"result {len(self.runs)}"

        return (journal or Journal(self.path, KEY)).keep_or_run(step, run, self.said.append)

    def test_what_is_noted_is_kept(self):
        self.assertEqual([self.keep_or_run(step) for step in (ONE, TWO, ONE)], ["result 1", "result 2", "result 1"])
        self.assertEqual((self.runs, self.said), (["one", "two"], ["one is kept"]))
        same = Journal(self.path, KEY | {"cores": 8})
        self.assertEqual([self.keep_or_run(ONE, same) for _ in range(2)], ["result 3", "result 3"])

    def test_what_another_build_made_is_made_again(self):
        self.keep_or_run(ONE)
        self.keep_or_run(ONE, Journal(self.path, KEY | {"git_hash": "b" * 40}))
        dirty = KEY | {"git_dirty": "true"}
        for _ in range(2):
            self.keep_or_run(ONE, Journal(self.path, dirty))
        self.assertEqual(len(self.runs), 4)
        self.keep_or_run(ONE)
        self.assertEqual(len(self.runs), 4)

    def test_a_line_that_was_being_written_costs_its_step_alone(self):
        self.keep_or_run(ONE)
        with self.path.open("a") as file:
            file.write('{"key": {"git_ha')
        self.keep_or_run(TWO)
        self.assertEqual([self.keep_or_run(step) for step in (ONE, TWO)], ["result 1", "result 2"])


# Ends well some time after it was told to stop, unless it is told again.
SLOW = """#!/usr/bin/python3
import os, signal, sys, time
if "--dry-run" in sys.argv:
    sys.exit(0)
def stop(number, frame):
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    time.sleep(1)
    with open(os.environ["STAND_IN_LOG"], "a") as log:
        log.write("ended\\n")
    sys.exit(130)
signal.signal(signal.SIGINT, stop)
with open(os.environ["STAND_IN_LOG"], "a") as log:
    log.write("begun\\n")
time.sleep(60)
"""


class InterruptionTest(StandInCase):
    script, stand_in = "reproduce", SLOW

    def test_a_run_is_told_once_and_ends_before_its_command(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            process = subprocess.Popen([SCRIPTS / "reproduce", "--scene", "rock_pile", "--out", self.directory / "out"],
                                       env=dict(os.environ, CLEAVE_PROGRAM=str(self.program), STAND_IN_LOG=str(self.log)),
                                       stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
            while "begun" not in self.log.read_text() and process.poll() is None:
                time.sleep(0.05)
            process.send_signal(number)
            said = process.communicate()[1].splitlines()
            self.assertEqual((process.returncode, said[-1]), (
                130, "reproduce: interrupted; the same command goes on, finished cells are kept"))
            self.assertEqual(self.calls(), ["begun", "ended"])


if __name__ == "__main__":
    unittest.main()
