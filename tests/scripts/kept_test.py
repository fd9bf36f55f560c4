"""The one way to run a cell if it is not done (scripts/cleave_scripts/results/kept.py), and how a run is interrupted."""
import collections
import os
import pathlib
import signal
import subprocess
import tempfile
import time
import unittest
import unittest.mock

from stand_in import StandInCase
from synthetic import ROOT, SCRIPTS

from cleave_scripts.results.kept import Journal, keep_or_run

KEY = {"git_hash": "a" * 40, "git_dirty": "false", "flags": "-O3", "build_type": "Release", "cpu_model": "C", "cores": 2}
Cell = collections.namedtuple("Cell", "label arguments")
ONE, TWO = Cell("one", ("run", "1")), Cell("two", ("run", "2"))


class KeepOrRunTest(unittest.TestCase):

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.path = pathlib.Path(scratch.name) / "below" / "cells.jsonl"
        self.runs, self.said = [], []

    def keep_or_run(self, cell, store=None, force=False):
        def run(cell):
            self.runs.append(cell.label)
            return f"result {len(self.runs)}"

        return keep_or_run(store or Journal(self.path, KEY), cell, run, force, self.said.append)

    def test_what_is_noted_is_kept_until_forced(self):
        self.assertEqual([self.keep_or_run(cell) for cell in (ONE, TWO, ONE)], ["result 1", "result 2", "result 1"])
        self.assertEqual((self.runs, self.said), (["one", "two"], ["one is kept"]))
        self.assertEqual(self.keep_or_run(ONE, force=True), "result 3")
        self.assertEqual(self.keep_or_run(ONE), "result 3")

    def test_why_what_is_there_does_not_count_is_told(self):
        store = unittest.mock.Mock()
        store.find.return_value = None, "made by others"
        self.keep_or_run(ONE, store)
        self.assertEqual(self.said, ["one: made by others"])
        store.add.assert_called_once_with(ONE, "result 1")

    def test_another_build_or_what_was_noted_beside_another_value_is_run_again(self):
        self.keep_or_run(ONE)
        self.keep_or_run(ONE, Journal(self.path, KEY | {"cores": 8}))
        self.keep_or_run(ONE, Journal(self.path, KEY, {"judges": "1"}))
        self.keep_or_run(ONE, Journal(self.path, KEY, {"judges": "2"}))
        self.assertEqual(len(self.runs), 4)
        self.keep_or_run(ONE, Journal(self.path, KEY, {"judges": "1"}))
        self.assertEqual(len(self.runs), 4)

    def test_a_line_that_was_being_written_costs_its_cell_alone(self):
        self.keep_or_run(ONE)
        with self.path.open("a") as file:
            file.write('{"key": {"git_ha')
        self.keep_or_run(TWO)
        self.assertEqual([self.keep_or_run(cell) for cell in (ONE, TWO)], ["result 1", "result 2"])


# Ends well some time after it was told to stop, unless it is told again.
SLOW = f"""#!/usr/bin/python3
import os, signal, sys, time
sys.path.insert(0, {str(ROOT / "tests" / "scripts")!r})
import stand_in_key
stand_in_key.answer()
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
                130, "reproduce: interrupted; the same command goes on, finished scenes are kept"))
            self.assertEqual(self.calls(), ["begun", "ended"])


if __name__ == "__main__":
    unittest.main()
