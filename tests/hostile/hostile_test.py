"""Quick seeds of every kind of hostile trial on the program, and every kind on a stand-in that misbehaves.

CLEAVE_PROGRAM is the program that is tried.
"""
import contextlib
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))

from cleave_scripts.torture import full_disk  # noqa: E402
from cleave_scripts.torture.registry import KINDS  # noqa: E402

PROGRAM = os.environ["CLEAVE_PROGRAM"]
HONEST = str(pathlib.Path(PROGRAM).resolve())
MISBEHAVING = pathlib.Path(__file__).resolve().parent / "misbehaving"
QUICK = {"problem-files": 60, "problem-flips": 15, "flips": 15, "edits": 15, "kills": 5, "interrupts": 3, "two-processes": 3,
         "full-disk": 4, "low-memory": 6, "streams": 6, "command-lines": 30, "campaign-flips": 20,
         "campaign-kills": 2, "random-runs": 6}
A_LONG_RUN = 51  # a seed whose first interrupt comes when the program has long begun
LOST = "crashes with SIGSEGV", "crashes with SIGABRT"


class TortureCase(unittest.TestCase):

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.out = pathlib.Path(scratch.name) / "out"

    def command(self, kinds, *options, seed=1):
        return [ROOT / "scripts" / "torture", "--minutes", "600", "--trials", kinds, "--seed", str(seed), "--out", self.out,
                *map(str, options)]

    def torture(self, kinds, *options, code, misbehaviour=None, seed=1):
        """What torture.json says afterwards."""
        environment = dict(os.environ, CLEAVE_PROGRAM=str(MISBEHAVING if misbehaviour else PROGRAM),
                           HONEST_PROGRAM=HONEST, MISBEHAVIOUR=misbehaviour or "")
        done = subprocess.run(self.command(kinds, *options, seed=seed), env=environment, capture_output=True, text=True,
                              check=False)
        told = self.out / "findings.jsonl"
        self.assertEqual(done.returncode, code, done.stderr + (told.read_text() if told.exists() else ""))
        return json.loads((self.out / "torture.json").read_text())


class ProgramTest(TortureCase):
    """No finding."""


def _add_quick_test(kind):

    def test(self):
        why = kind.missing()
        if why:
            self.skipTest(why)
        result = self.torture(kind.name, "--count", QUICK[kind.name], code=0)
        self.assertEqual(result["kinds"][kind.name]["trials"], QUICK[kind.name])

    setattr(ProgramTest, f"test_{kind.name.replace('-', '_')}", test)


for each in KINDS:
    _add_quick_test(each)


class MisbehavingTest(TortureCase):
    """Every kind finds what it is there for."""

    def check(self, misbehaviour, expected, *options, count=2, seed=1):
        """expected: {kind: words of a finding}"""
        result = self.torture(",".join(expected), "--count", count, *options, code=3, misbehaviour=misbehaviour, seed=seed)
        for kind, words in expected.items():
            self.assertIn(words, " ".join(result["kinds"][kind]["found"]), (misbehaviour, kind))

    def test_crashes(self):
        self.check("crash", {kind.name: LOST[0] for kind in KINDS
                             if kind.name not in ("kills", "interrupts", "full-disk", "campaign-kills")})

    def test_hangs(self):
        self.check("hang", dict.fromkeys(("problem-files", "low-memory", "random-runs"), "hangs"), "--patience", 1, count=1)

    def test_streams(self):
        self.check("ignore_full_output", {"streams": "loses what it prints"}, count=12)
        self.check("write_to_what_is_open", {"streams": "leaves a broken file"}, count=12)

    def test_files_of_refused_commands(self):
        self.check("litter", {"command-lines": "leaves files", "problem-files": "refuses and writes"}, count=12)

    def test_error_lines(self):
        for misbehaviour, words in (("two_lines", "several error lines"), ("control_line", "control characters"),
                                    ("no_line", "no error line"), ("traceback", "Traceback")):
            self.check(misbehaviour, {"problem-files": words, "problem-flips": words}, count=1)

    def test_damage_that_is_believed(self):
        self.check("believe", {"problem-files": "verify: exit code 0", "problem-flips": "believes a problem file",
                               "flips": "believes a flip", "edits": "believes", "campaign-flips": "believes a flip"}, count=12)

    def test_campaigns_that_lose_a_cell(self):
        if full_disk.missing():
            self.skipTest(full_disk.missing())
        self.check("lose_a_cell", {"campaign-kills": "not every cell is there once and ok"}, count=1)

    def test_good_results_that_are_refused(self):
        self.check("doubt", {"random-runs": "verify: exit code 1", "two-processes": "verify: exit code 1",
                             "kills": "verify: exit code 1"})

    def test_half_files(self):
        self.check("write_half", {"kills": "that is broken"}, count=6)

    def test_commands_that_do_not_complete_after_a_kill(self):
        self.check("refuse_again", {"kills": "again: exit code 1"})

    def test_signals_that_are_not_heard(self):
        self.check("be_deaf", {"interrupts": "hangs"}, "--patience", 2, count=1, seed=A_LONG_RUN)

    def test_directories_without_a_lock(self):
        self.check("take_no_lock", {"two-processes": "two processes write one directory"}, count=6)

    def test_full_disks(self):
        if full_disk.missing():
            self.skipTest(full_disk.missing())
        self.check("crash_on_failure", {"full-disk": LOST[0]}, count=6)
        self.check("blame_nobody", {"full-disk": "does not name file and cause"}, count=6)
        self.check("blame_nobody", {"campaign-kills": "does not name the cause"}, count=1)

    def test_little_memory(self):
        self.check("crash_with_little_memory", {"low-memory": LOST[1]})

    def test_rows_that_flatter(self):
        self.check("flatter", {"problem-files": "ok above the limit", "random-runs": "ok above the limit"}, count=10)


class CommandTest(TortureCase):

    def test_an_interrupt_ends_it_with_the_counts_so_far(self):
        environment = dict(os.environ, CLEAVE_PROGRAM=PROGRAM)
        with subprocess.Popen(self.command("edits"), env=environment, stderr=subprocess.PIPE, text=True) as running:
            while not (self.out / "torture.json").is_file():
                self.assertIsNone(running.poll())
                time.sleep(0.05)
            running.send_signal(signal.SIGINT)
            told = running.communicate()[1]
        self.assertEqual(running.returncode, 130, told)
        self.assertNotIn("Traceback", told)
        self.assertEqual(json.loads((self.out / "torture.json").read_text())["state"], "interrupted")
        self.assertIn("# Hostile trials", (self.out / "torture.md").read_text())

    def test_an_interrupt_leaves_nothing_running(self):
        environment = dict(os.environ, CLEAVE_PROGRAM=str(MISBEHAVING), HONEST_PROGRAM=HONEST, MISBEHAVIOUR="hang")
        with subprocess.Popen(self.command("two-processes"), env=environment, stderr=subprocess.PIPE, text=True) as running:
            while not (hanging := self.children_of(running.pid)):
                self.assertIsNone(running.poll())
                time.sleep(0.05)
            time.sleep(0.5)  # it may be one that is only being started
            running.send_signal(signal.SIGINT)
            running.communicate()
        self.assertEqual(running.returncode, 130)
        self.assertFalse([pid for pid in hanging if pathlib.Path(f"/proc/{pid}").exists()])

    @classmethod
    def children_of(cls, pid):
        """Those that hang in a trial: children of lanes."""
        found = []
        with contextlib.suppress(OSError):  # it has ended
            for child in pathlib.Path(f"/proc/{pid}/task/{pid}/children").read_text().split():
                found += cls.children_of(child)
                if os.readlink(f"/proc/{child}/cwd").endswith("two-processes-0"):
                    found.append(child)
        return found

    def test_a_finding_is_repeated_by_its_number(self):
        self.torture("edits", "--count", 3, code=3, misbehaviour="believe")
        how = (self.out / "findings" / "edits-2" / "how.txt").read_text()
        self.assertIn("--seed 1 --only 2", how)
        self.torture("edits", "--only", 2, code=3, misbehaviour="believe")
        self.assertEqual((self.out / "findings" / "edits-2" / "how.txt").read_text(), how)

    def test_a_kind_that_cannot_be_run_is_no_success(self):
        environment = dict(os.environ, CLEAVE_PROGRAM=PROGRAM, PATH="/nowhere")
        done = subprocess.run(self.command("full-disk", "--count", "1"), env=environment, capture_output=True, text=True,
                              check=False)
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertIn("NOT RUN: full-disk", done.stderr)
        self.assertIn("NOT RUN", (self.out / "torture.md").read_text())

    def test_bad_options_are_one_line(self):
        for words in (["--trials", "edits,nothing"], ["--minutes", "0"], ["--count", "-1"], ["--seed", "x"]):
            done = subprocess.run([*self.command("edits"), *words], capture_output=True, text=True, check=False)
            self.assertEqual((done.returncode, len(done.stderr.splitlines())), (1, 1), done.stderr)
            self.assertFalse(self.out.exists())


if __name__ == "__main__":
    unittest.main()
