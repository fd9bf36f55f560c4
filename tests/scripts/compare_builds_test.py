"""scripts/compare_builds with stand-ins for the two programs, and what is made of its rows."""
import csv
import os
import pathlib
import runpy
import subprocess
import tempfile
import unittest
import unittest.mock

from stand_in import NOTES_ITS_CALL, StandInCase
from synthetic import SCRIPTS

from cleave_scripts.documents import speed
from cleave_scripts.documents.stored import Stored
from cleave_scripts.measurements import builds

# The earlier program takes 8 ms, and fails on what STAND_IN_FAILS names; this one takes 4 ms, and a ms more every round.
STAND_IN = NOTES_ITS_CALL + """from synthetic import write_manifest, write_steps
earlier = "earlier" in sys.argv[0]
if words == ["--version"]:
    known = os.environ.get("STAND_IN_FAILS") != "version"
    print("cleave 0", known and f"(commit {'a' if earlier else 'b'}123456789abc, clean)")
    sys.exit()
out = pathlib.Path(given["--out"])
out.mkdir(parents=True, exist_ok=True)
if words[0] == "record":
    assert earlier
    for step in given["--at"].split(","):
        (out / f"{given['--scene']}_step{int(step):06}.h5").write_text(" ".join(words))
    sys.exit(0)
rows = []
for file in (word for word in words if word.endswith(".h5")):
    asked = pathlib.Path(file).read_text().split()
    asked = dict(zip(asked, asked[1:]))
    for solver in given["--solver"].split(","):
        fails = earlier and os.environ.get("STAND_IN_FAILS") == f"{solver} {asked['--scene']} {int(file[-9:-3])}"
        rounds = sum(line.startswith("replay") for line in open(os.environ["STAND_IN_LOG"]))
        rows.append(dict(scene=asked["--scene"], bodies=asked.get("--bodies", 200), cfm=float(asked.get("--cfm", 1e-5)),
                         step=int(file[-9:-3]), rows=900, solver=solver, threads=int(given["--threads"]), factorizations=7,
                         status="not_converged" if fails else "ok", t_s_ms=8 if earlier else 4 + rounds / 1000))
write_steps(out, rows)
write_manifest(out)
"""


class CompareBuildsTest(StandInCase):
    script, stand_in = "compare_builds", STAND_IN

    def compare(self, *arguments, code=0, fails=""):
        earlier = self.directory / "earlier_cleave"
        earlier.write_text(STAND_IN)
        earlier.chmod(0o755)
        with unittest.mock.patch.dict(os.environ, CLEAVE_EARLIER=str(earlier), STAND_IN_FAILS=fails):
            return self.run_it("--rounds", 2, *arguments, code=code)

    def rows(self):
        with open(self.directory / "out" / "compare_builds.csv", newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_both_builds_solve_the_same_files_in_turn(self):
        said = self.compare("--threads", 2).stdout
        problems = len(builds.PROBLEMS)
        calls = [call for call in self.calls() if call != "--version"]
        self.assertEqual([call.split()[0] for call in calls], ["record"] * problems + ["replay"] * (2 * 2 * problems))
        replays = [call.partition(" --out")[0] for call in calls[problems:]]
        self.assertEqual(replays[::2], replays[1::2])
        self.assertTrue(all("--cold" in call and "--threads 2" in call for call in replays))
        rows = self.rows()
        self.assertEqual([row["build"] for row in rows if row["step"] == "300" and row["scene"] == "log_tower"],
                         ["earlier"] * 3 + ["this"] * 3 + ["this"] * 3 + ["earlier"] * 3)
        self.assertEqual({row["git_hash"] for row in rows if row["build"] == "this"}, {"b123456789abc"})
        self.assertIn("| ms, a123456789 | ms, b123456789 | ratio |", said)
        self.assertRegex(said, r"\| rock_pile \| 200 \| 1e-05 \| `exact` \| 3 \| 8.00 \| 4.00 \| 0.500 \| - \|")
        self.assertRegex(said, r"\n21 figures of 21, 0.50 of the earlier time on the geometric mean, at most 0.50\n")
        told = speed.compare_builds(Stored(self.directory / "out"))
        self.assertIn("0.50 of the earlier time", told)
        self.assertIn("| log_tower | 200 | 1e-05 | `schur` | 2 | 8.00 |", told)

    def test_steps_that_a_build_did_not_solve_are_told_and_left_out(self):
        failed = r" \| 1 by the earlier build \|"
        said = self.compare(fails="schur rock_pile 300").stdout
        self.assertRegex(said, r"\| rock_pile \| 200 \| 1e-05 \| `schur` \| 3 \| 8.00 \| 4.00 \| 0.50\d" + failed)
        said = self.compare(fails="exact large_rock_pile 200").stdout
        self.assertRegex(said, r"\| large_rock_pile \| 200 \| 1e-05 \| `exact` \| 1 \| - \| - \| -" + failed)
        self.assertIn("20 figures of 21", said)

    def test_what_cannot_be_the_earlier_build_is_one_line(self):
        self.check_refused((("--commit", "nope"), "--commit is 'nope', expected a commit of this checkout"))
        with unittest.mock.patch.dict(os.environ, CLEAVE_EARLIER="/nowhere"):
            self.check_refused(((), "CLEAVE_EARLIER is '/nowhere', which cannot be run"))
        self.assertIn("--version does not say a commit", self.compare(code=1, fails="version").stderr.splitlines()[-1])
        self.assertRegex(self.compare("--commit", "HEAD", code=1).stderr.splitlines()[-1],
                         r"CLEAVE_EARLIER is a build of commit a123456789\w*, and --commit is 'HEAD'$")


class EarlierBuildTest(unittest.TestCase):

    def commit(self, checkout, prints):
        """The commit of a checkout whose set-up makes a program that prints this."""
        setup = checkout / "scripts" / "setup"
        setup.parent.mkdir(exist_ok=True)
        setup.write_text(f"#!/bin/sh\ncd $(dirname $0)/.. && mkdir -p build/release && "
                         f"echo 'echo {prints} '$* > build/release/cleave\n")
        setup.chmod(0o755)
        for words in (("init", "-q"), ("add", "."), ("-c", "user.name=a", "-c", "user.email=a@b", "commit", "-q", "-m", "x")):
            subprocess.run(["git", "-C", checkout, *words], check=True)
        done = subprocess.run(["git", "-C", checkout, "rev-parse", "HEAD"], check=True, capture_output=True, text=True)
        return done.stdout.strip()

    def test_is_made_by_its_own_set_up_and_follows_the_commit(self):
        with tempfile.TemporaryDirectory() as directory:
            checkout, place = pathlib.Path(directory) / "checkout", pathlib.Path(directory) / "out" / "earlier"
            checkout.mkdir()
            first, second = self.commit(checkout, "first"), self.commit(checkout, "second")
            build_earlier = runpy.run_path(str(SCRIPTS / "compare_builds"))["build_earlier"]
            with unittest.mock.patch.dict(build_earlier.__globals__, ROOT=checkout):
                for commit, prints in ((first, "first"), (second, "second"), (first, "first")):
                    program = build_earlier(commit, place)
                    said = subprocess.run(["sh", program], check=True, capture_output=True, text=True).stdout
                    self.assertEqual(said, f"{prints} --preset release --target cleave\n")
                # One that came after the clone, and a name that means another commit there.
                later = self.commit(checkout, "later")
                for commit, prints in ((later, "later"), (first, "first"), ("HEAD~1", "second")):
                    self.assertIn(prints, build_earlier(commit, place).read_text())


if __name__ == "__main__":
    unittest.main()
