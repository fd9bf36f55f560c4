"""The drill: a partitioner that is not grown, a column and a baseline come in, each as one file and one row
(newcomers.patch), and everything takes them without another edit.

A copy of the tree and of what is built gets the patch; only what it touches is compiled again.
"""
import csv
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ["CLEAVE_BINARY_DIR"])
HERE = pathlib.Path(__file__).parent
TARGETS = ("cleave", "partition_tests", "solver_tests")


def run(*command, cwd=None, codes=(0,), **environment):
    done = subprocess.run([str(word) for word in command], cwd=cwd, text=True, capture_output=True, check=False,
                          env=os.environ | environment)
    if done.returncode not in codes:
        raise AssertionError(f"{command}: exit code {done.returncode}\n{done.stdout[-4000:]}\n{done.stderr[-4000:]}")
    return done.stdout


def copy_sources(to):
    names = run("git", "ls-files", "--cached", "--others", "--exclude-standard", "-z", cwd=ROOT).split("\0")
    for name in filter(None, names):
        if name.startswith("results/") and not name.endswith(".md") or not (ROOT / name).is_file():
            continue
        (to / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(ROOT / name, to / name)


def copy_build(to):
    """Objects, libraries and ninja's notes, with the old place replaced by the new one in cmake's cache."""
    shutil.copytree(BUILD, to, ignore=shutil.ignore_patterns("*_benchmark", "*_tests", "Testing", "*.log"))
    shutil.copy2(BUILD / ".ninja_log", to / ".ninja_log")
    cache = to / "CMakeCache.txt"
    cache.write_text(cache.read_text().replace(str(ROOT), str(to.parents[1])))


class DrillTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.directory = tempfile.TemporaryDirectory(prefix="cleave_drill_")
        cls.addClassCleanup(cls.directory.cleanup)
        cls.tree = pathlib.Path(cls.directory.name) / "tree"
        cls.out = pathlib.Path(cls.directory.name) / "out"
        cls.tree.mkdir()
        copy_sources(cls.tree)
        build = cls.tree / "build" / BUILD.name
        copy_build(build)
        run("git", "apply", "--unsafe-paths", f"--directory={cls.tree}", HERE / "newcomers.patch", cwd="/")
        run("cmake", "-S", cls.tree, "-B", build)
        run("cmake", "--build", build, "--target", *TARGETS)
        cls.build, cls.program = build, build / "cleave"
        cls.cleave("run", "--scene", "rock_pile", "--bodies", "30", "--steps", "40", "--measure-every", "20", "--repeats",
                   "1", "--partitioner", "all,stripes@stripe-bodies=5", "--refiner", "all", "--solver",
                   "schur,relax,relax@relaxations=40", "--out", cls.out / "run", codes=(0, 2))
        with open(cls.out / "run" / "steps.csv", encoding="utf-8") as file:
            cls.rows = list(csv.DictReader(file))

    @classmethod
    def cleave(cls, *arguments, codes=(0,)):
        return run(cls.program, *arguments, codes=codes)

    def script(self, name, *arguments, codes=(0,)):
        return run(self.tree / "scripts" / name, *arguments, codes=codes, CLEAVE_PROGRAM=str(self.program))

    def test_each_newcomer_is_one_file_and_one_row(self):
        text = (HERE / "newcomers.patch").read_text(encoding="utf-8")
        files = re.findall(r"^diff --git a/(\S+)", text, re.M)
        new = re.findall(r"^\+\+\+ b/(\S+)", "\n".join(part for part in text.split("diff --git ") if "new file" in part),
                         re.M)
        self.assertEqual(sorted(set(files) - set(new)), ["harness/experiment/cell_measures.cpp",
                                                         "partition/registry.cpp", "solver/registry.cpp"])
        self.assertEqual(len(new), 3)
        self.assertFalse(re.search(r"^-(?!--)", text, re.M), "a line of the tree is changed")

    def test_list_and_help_show_them(self):
        self.assertIn("stripes", self.cleave("list", "partitioners", "--names").split())
        self.assertIn("relax", self.cleave("list", "solvers", "--names").split())
        self.assertIn("largest_impulse_n_s", self.cleave("list", "columns", "--names").split())
        text = self.cleave("run", "--help")
        self.assertRegex(text, r"--stripe-bodies N .*\[1, 1000\] \(10\); of partitioner stripes")
        self.assertRegex(text, r"--relaxations N .*\[1, 1000\] \(10\); of solver relax")

    def test_all_means_them_too_and_paper_does_not(self):
        names = {row["partitioner"] for row in self.rows}
        self.assertTrue({"mindp", "stripes", "stripes@stripe-bodies=5"} <= names)
        self.cleave("run", "--scene", "rock_pile", "--bodies", "5", "--steps", "2", "--partitioner", "paper", "--out",
                    self.out / "paper")
        with open(self.out / "paper" / "steps.csv", encoding="utf-8") as file:
            self.assertNotIn("stripes", {row["partitioner"] for row in csv.DictReader(file)})

    def test_rows_hold_their_parameters_and_the_column(self):
        for row in self.rows:
            wanted = {"stripes": "10", "stripes@stripe-bodies=5": "5"}.get(row["partitioner"], "-")
            self.assertEqual(row["stripe_bodies"], wanted)
            self.assertEqual(row["relaxations"], {"relax": "10", "relax@relaxations=40": "40"}.get(row["solver"], "-"))
            self.assertGreater(float(row["largest_impulse_n_s"]) + (row["rows"] == "0"), 0)

    def test_a_wrong_value_and_a_wrong_owner_are_refused_by_name(self):
        for option, text in (("stripes@stripe-bodies=0", "0 is not in [1, 1000]"),
                             ("mindp@stripe-bodies=5", "stripe-bodies is a parameter of partitioner stripes")):
            done = subprocess.run([self.program, "run", "--scene", "rock_pile", "--partitioner", option, "--out",
                                   self.out / "refused"], text=True, capture_output=True, check=False)
            self.assertEqual(done.returncode, 1)
            self.assertIn(text, done.stderr)

    def test_replay_and_verify(self):
        self.cleave("record", "--scene", "rock_pile", "--bodies", "30", "--at", "39", "--out", self.out / "recorded")
        file = next((self.out / "recorded").glob("*.h5"))
        self.cleave("replay", file, "--partitioner", "stripes@stripe-bodies=5,mix", "--refiner", "all", "--solver",
                    "schur,relax", "--write-solutions", "--out", self.out / "replayed", codes=(0, 2))
        checks = self.cleave("verify", self.out / "replayed")
        self.assertIn("partition/stripes@stripe-bodies=5+fm+schur: ", checks)
        self.assertNotIn("FAIL", checks)

    def test_table_and_figures(self):
        table = self.script("table1", self.out / "run")
        self.assertRegex(table, r"stripes +none")
        self.assertRegex(table, r"stripes@stripe-bodies=5 +fm")
        self.script("report", self.out / "run", "--out", self.out / "report")
        page = "".join(file.read_text(encoding="utf-8") for file in (self.out / "report").rglob("*.html"))
        self.assertIn("stripes", page)

    def test_reproduce_runs_beside_them(self):
        self.script("reproduce", "--steps", "2", "--repeats", "1", "--threads", "1", "--out", self.out / "reproduced",
                    codes=(0, 2, 3))
        tables = list((self.out / "reproduced").rglob("steps.csv"))
        self.assertGreaterEqual(len(tables), 4)

    def test_contract_tests_take_them(self):
        for program, name in (("partition_tests", "stripes"), ("solver_tests", "relax")):
            text = run(self.build / "tests" / program, f"--gtest_filter=*{name}*")
            self.assertRegex(text, r"\[  PASSED  \] ([5-9]|\d\d) tests")


if __name__ == "__main__":
    unittest.main()
