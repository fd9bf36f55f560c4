"""The judge of the hostile trials against closed forms, and what damages files and cells: it always damages."""
import math
import os
import pathlib
import random
import re
import shlex
import signal
import subprocess
import sys
import tempfile
import time
import types
import unittest

import h5py
import numpy as np

from synthetic import ROOT

from cleave_scripts.results.errors import ResultError
from cleave_scripts.torture import endings, two_processes
from cleave_scripts.torture.cell_edits import changed_cell
from cleave_scripts.torture.changes_of_values import ANY
from cleave_scripts.torture.child import Ending
from cleave_scripts.torture.findings import Keeper
from cleave_scripts.torture.foreign_file import write_foreign
from cleave_scripts.torture.guarded import Unreadable, guarded
from cleave_scripts.torture.judge import Problem, judge, judge_file
from cleave_scripts.torture.lanes import Lanes
from cleave_scripts.torture.meaning import meaning
from cleave_scripts.torture.problem_files import ARRAY_CHANGES, FILE_CHANGES
from cleave_scripts.torture.trial import Finding

MASS, FALL, COMPLIANCE, MU = 2.0, -0.1635, 1e-6, 0.5
LOAD = -FALL / (1 / MASS + COMPLIANCE)  # impulse that carries the ball


def ball(side=0.0):
    """A ball on the ground: a normal row and a friction row along x, as datasets of a problem file."""
    inertia = np.diag([MASS] * 3 + [0.2] * 3)
    return {"mass": inertia[None], "free_velocity": np.array([[side, 0, FALL, 0, 0, 0]]),
            "row_body": np.array([[0, -1]] * 2), "jacobian": np.array([[0, 0, 1.0] + [0] * 9, [1.0] + [0] * 11]),
            "rhs": np.zeros(2), "compliance": np.full(2, COMPLIANCE),
            "lower": np.array([0, -MU * LOAD]), "upper": np.array([np.inf, MU * LOAD])}


class TwoProcessesTest(unittest.TestCase):

    def findings(self, *, forced, refused, said):
        """Of two processes 11 and 12, the second forced, of which one is refused."""
        found = []
        started = [("replay", types.SimpleNamespace(pid=11), ["--force"] if forced else []),
                   ("run", types.SimpleNamespace(pid=12), ["--force"])]
        codes = [endings.BAD_INPUT if number == refused else endings.DONE for number in (0, 1)]
        trial = types.SimpleNamespace(find=lambda what, detail="": found.append(what))
        two_processes.check_refusal(trial, started, [types.SimpleNamespace(code=code, err=said) for code in codes], False)
        return found

    def test_the_refused_one_is_told_who_holds_the_directory(self):
        full, held = "--out: 'out' already holds steps.csv", "'out' is held by process {}"
        self.assertEqual(self.findings(forced=False, refused=0, said=held.format(12)), [])
        self.assertEqual(self.findings(forced=False, refused=0, said=full), [])  # overtaken
        for forced, refused, said in ((False, 0, "no"), (True, 0, full), (False, 1, full), (False, 1, held.format(12))):
            with self.subTest(said, forced=forced, refused=refused):
                self.assertEqual(self.findings(forced=forced, refused=refused, said=said),
                                 ["the refused process is not told who holds the directory"])


class JudgeTest(unittest.TestCase):

    def verdict(self, impulse, side=0.0, **changes):
        problem = Problem(ball(side) | changes)
        velocity = problem.velocity(np.asarray(impulse, np.longdouble)) if np.isfinite(impulse).all() else None
        return judge(problem, impulse, velocity)

    def test_closed_forms_are_exact(self):
        for side, friction in ((0, 0), (0.01, -0.01 / (1 / MASS + COMPLIANCE)), (5, -MU * LOAD), (-5, MU * LOAD)):
            verdict = self.verdict([LOAD, friction], side)
            self.assertLess(verdict.residual, 1e-15)
            self.assertFalse(verdict.above())
            self.assertEqual(verdict.limit, 1e-9 * max(1, abs(side)))

    def test_closed_forms_of_cones_are_exact(self):
        diagonal = 1 / MASS + COMPLIANCE
        for side in (0.01, 0.05, 5.0, -5.0):
            lifted = max(LOAD, (-FALL + MU * abs(side)) / (diagonal * (1 + MU * MU)))
            for contact_set, load in ((1, lifted), (2, LOAD)):
                friction = -np.sign(side) * min(abs(side) / diagonal, MU * load)
                sets = {"contact_set": np.array([contact_set, 0]), "friction_row": np.array([-1, 0]),
                        "friction_coefficient": np.array([0, MU])}
                with self.subTest(side, contact_set=contact_set):
                    self.assertLess(self.verdict([load, friction], side, **sets).residual, 1e-15)
                    self.assertTrue(self.verdict([load, friction + 1e-6], side, **sets).above())
                    self.assertTrue(self.verdict([load + 1e-6, friction], side, **sets).above())

    def test_a_residual_is_told_in_metres_per_second(self):
        verdict = self.verdict([1.01 * LOAD, 0])
        self.assertAlmostEqual(verdict.residual, 0.01 * LOAD * (1 / MASS + COMPLIANCE), 12)
        self.assertTrue(verdict.above())
        self.assertTrue(verdict.differs_from(0.9 * verdict.residual))
        self.assertFalse(verdict.differs_from(verdict.residual))

    def test_a_billionth_too_much_is_above(self):
        self.assertFalse(self.verdict([LOAD + 1e-9, 0]).above())
        self.assertTrue(self.verdict([LOAD + 3e-9, 0]).above())

    def test_bounds_hold(self):
        for impulse in ([-LOAD, 0], [LOAD, -2 * MU * LOAD], [0, 0]):
            self.assertTrue(self.verdict(impulse, 5).above(), impulse)

    def test_impulses_that_are_no_numbers_are_above(self):
        for number in (math.nan, math.inf):
            self.assertTrue(self.verdict([LOAD, number]).above())

    def test_two_bodies_and_a_row_without_effect(self):
        arrays = {name: np.concatenate([ball()[name]] * 2) for name in ("mass", "free_velocity")}
        upper = np.array([[0, 0, 1.0, 0, 0, 0, 0, 0, -1.0, 0, 0, 0], [0.0] * 12])
        arrays |= {"row_body": np.array([[0, 1], [0, 1]]), "jacobian": upper}
        verdict = self.verdict([0, 0], **arrays)
        self.assertEqual((verdict.residual, verdict.velocity_error), (0, 0))
        self.assertAlmostEqual(self.verdict([1.0, 0], **arrays).residual, 2 / MASS + COMPLIANCE, 12)


class DamageTest(unittest.TestCase):

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.directory = pathlib.Path(scratch.name)
        self.path, self.changed = self.directory / "balls.h5", self.directory / "changed.h5"
        page = (ROOT / "harness" / "files" / "PROBLEM_FILES.md").read_text(encoding="utf-8")
        writer = re.search(r"```python\n(.*?)```", page, re.S).group(1)
        subprocess.run([sys.executable, "-c", writer, self.path], check=True)
        with h5py.File(self.path, "r+") as file:
            file.attrs.update(scene="balls", step=1, seed=1, friction_model="box", erp=0.2, cfm=1e-6)
            file["row_kind"] = np.where(file["friction_row"][:] < 0, 1, 2).astype("u1")
            file["row_constraint"] = np.repeat([0, 1], 3).astype("i4")
            file["contact_point"], file["warm_impulse"] = np.ones((6, 3)), np.ones(6)
            file["position"], file["orientation"] = np.ones((2, 3)), np.tile([1.0, 0, 0, 0], (2, 1))

    def test_every_change_can_be_made(self):
        for name, expected, change in ARRAY_CHANGES:
            for seed in range(20):
                for path in self.directory.iterdir():
                    path.unlink() if path != self.path else None
                write_foreign(self.path, self.changed)
                before = self.changed.read_bytes()
                with self.subTest(name, seed=seed), h5py.File(self.changed, "r+") as file:
                    change(file, random.Random(seed))
                self.assertTrue(expected == ANY or self.changed.read_bytes() != before, name)

    def test_every_file_can_be_spoilt(self):
        for name, _, change in FILE_CHANGES:
            with self.subTest(name):
                write_foreign(self.path, self.changed)
                change(self.changed, random.Random(1))
                self.assertFalse(self.changed.is_file() and self.changed.read_bytes() == self.path.read_bytes())
                self.changed.rmdir() if self.changed.is_dir() and not self.changed.is_symlink() else self.changed.unlink()

    def test_the_meaning_is_that_of_the_defaults_and_no_other(self):
        write_foreign(self.path, self.changed)
        self.assertEqual(meaning(self.changed), meaning(self.path))
        with h5py.File(self.changed, "r+") as file:
            del file["row_kind"], file["row_constraint"]
            file["something_else"] = 1.0
        self.assertEqual(meaning(self.changed), meaning(self.path))
        with h5py.File(self.changed, "r+") as file:
            del file["warm_impulse"]
        self.assertNotEqual(meaning(self.changed), meaning(self.path))

    def test_what_cannot_be_read_is_no_end(self):
        self.changed.write_bytes(b"\x89HDF")
        with self.assertRaisesRegex(Unreadable, "OSError"):
            guarded(judge_file, self.changed, self.changed)
        with self.assertRaisesRegex(Unreadable, "crashes"):
            guarded(lambda: __import__("os").abort())
        with self.assertRaisesRegex(Unreadable, "too long"):
            guarded(lambda: time.sleep(600), seconds=0)

    def test_a_changed_cell_says_something_else(self):
        for text in ("0", "1", "-1", "12", "0.5", "1e-300", "nan", "inf", "-", "ok", "mix", "a1b2", "-0.25"):
            for seed in range(200):
                cell = changed_cell(random.Random(seed), text, 1e-6)
                self.assertNotEqual(cell, text)
                if text[-1].isdigit() and "b" not in text and cell.replace(".", "").lstrip("-").isdigit():
                    self.assertNotEqual(float(cell), float(text))


def rest(tally):
    """Only an interrupt ends it in time."""
    time.sleep(600)
    tally.counts["flips"]["restarts"] += 1


class LanesTest(unittest.TestCase):

    def watch(self, make, tell=lambda *_: None):
        """The last tally, and whether it was interrupted."""
        last = []
        interrupted = Lanes(3, make).watch(lambda text, tally: (last.append(tally), tell(text, tally)))
        return last[-1], interrupted

    def test_the_tallies_are_summed(self):

        def make(lane, tally, tell):
            tell("")  # a count of nothing must not be added a second time
            tally.counts["flips"].update(trials=lane + 1, findings=1)
            tally.found["flips"]["a fault"] += 1
            tell("a finding")

        tally, interrupted = self.watch(make)
        self.assertFalse(interrupted)
        self.assertEqual(tally.counts["flips"], {"trials": 6, "findings": 3})
        self.assertEqual(tally.found["flips"], {"a fault": 3})

    def test_an_interrupted_lane_tells_what_it_has(self):

        def make(lane, tally, tell):
            tally.counts["flips"]["trials"] = 1
            tell("begun")
            rest(tally)

        def interrupt(text, tally):
            if tally.total("trials") == 3 and text:
                os.kill(os.getpid(), signal.SIGINT)

        tally, interrupted = self.watch(make, interrupt)
        self.assertTrue(interrupted)
        self.assertEqual((tally.total("trials"), tally.total("restarts")), (3, 0))

    def test_an_interrupt_before_the_lanes_are_watched_is_not_lost(self):
        lanes, last = Lanes(3, lambda lane, tally, tell: rest(tally)), []
        os.kill(os.getpid(), signal.SIGINT)
        self.assertTrue(lanes.watch(lambda _, tally: last.append(tally)))
        self.assertEqual(last[-1].total("restarts"), 0)

    def test_an_interrupt_that_a_lane_missed_is_told_again(self):

        def make(lane, tally, tell):
            signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGTERM])
            tell("begun")
            signal.sigwait([signal.SIGTERM])
            signal.pthread_sigmask(signal.SIG_UNBLOCK, [signal.SIGTERM])
            rest(tally)

        tally, interrupted = self.watch(make, lambda text, _: text and os.kill(os.getpid(), signal.SIGINT))
        self.assertTrue(interrupted)
        self.assertEqual(tally.total("restarts"), 0)

    def test_a_lane_whose_interrupt_was_dropped_ends_when_it_tells(self):

        def make(lane, tally, tell):
            tally.counts["flips"]["trials"] = 1
            try:
                tell("begun")
                rest(tally)
            except KeyboardInterrupt:
                pass  # as Python does with what is raised in its hooks at a fork
            tell("")
            tally.counts["flips"]["trials"] = 100

        tally, interrupted = self.watch(make, lambda text, _: text and os.kill(os.getpid(), signal.SIGINT))
        self.assertTrue(interrupted)
        self.assertLess(tally.total("trials"), 100)

    def test_a_lane_that_dies_is_an_error(self):
        with self.assertRaisesRegex(ResultError, "lane 1 .* exit code 7"):
            self.watch(lambda lane, tally, tell: lane == 1 and os._exit(7))


class FindingsTest(unittest.TestCase):

    def test_what_repeats_a_finding_is_a_whole_command_and_leaves_what_was_found(self):
        with tempfile.TemporaryDirectory() as scratch:
            out, trial = pathlib.Path(scratch) / "some out", types.SimpleNamespace(
                kind="flips", number=7, seed=3, log=["$ cleave verify x"], findings=[Finding("a fault", "")],
                directory=pathlib.Path(scratch) / "trial")
            trial.directory.mkdir()
            (trial.directory / "input").touch()
            out.mkdir()
            Keeper(out).keep(trial, lambda _: None)
            how = out / "findings" / "flips-7" / "how.txt"
            words = shlex.split(how.read_text().splitlines()[0])
            given = dict(zip(words[1::2], words[2::2]))
            self.assertEqual({name: given.pop(name) for name in ("--trials", "--seed", "--only")},
                             {"--trials": "flips", "--seed": "3", "--only": "7"})
            self.assertEqual(set(given), {"--minutes", "--out"})
            Keeper(pathlib.Path(given["--out"]))
            self.assertTrue(how.exists() and (out / "findings.jsonl").exists())


class EndingsTest(unittest.TestCase):

    def fault(self, code, err="", out="", hung=False):
        return endings.fault(Ending((), code, out, err, 0.0, hung), (0, 1, 3))

    def test_what_is_promised_is_no_fault(self):
        for case in ((0, "told\nand told"), (1, "cleave: no"), (3, "a\nb", "FAIL"),
                     (1, f"a.h5: problem of x step 1: 2 bodies, hash {'0' * 16}\ncleave verify: no", "ok"),
                     (1, "Error in GnuTLS initialization: not found.\n\nlibgomp: Out of memory allocating 8 bytes"),
                     (1, "replay: step 4 of 6, 14 s, about 7 s to go\ncleave replay: disk/out: cannot be written")):
            self.assertIsNone(self.fault(*case), case)

    def test_what_is_not_promised_is_named(self):
        for case, words in (((1, ""), "no error line"), ((1, "a\nb"), "several error lines"), ((2, "a"), "exit code 2"),
                            ((1, "a\x1bb"), "control characters"), ((-11, ""), "crashes with SIGSEGV"),
                            ((0, "Traceback (most recent call last):"), "Traceback"),
                            ((-9, "", "", True), "hangs")):
            self.assertIn(words, self.fault(*case), case)


if __name__ == "__main__":
    unittest.main()
