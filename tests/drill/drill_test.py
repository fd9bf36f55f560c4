"""The drill: a partitioner that is not grown, a column and a baseline come in, each as one file and one row
(rows.toml), and everything takes them without another edit.

A copy of the tree gets them; only what they touch is compiled, and linked with what is built.
"""
import csv
import json
import os
import pathlib
import shlex
import shutil
import subprocess
import tempfile
import tomllib
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ["CLEAVE_BINARY_DIR"])
HERE = pathlib.Path(__file__).parent
NEWCOMERS = tomllib.loads((HERE / "rows.toml").read_text())["newcomer"]


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


def compiled(newcomer, tree, objects):
    """Compiles the newcomer and its registry as the build compiles that registry."""
    entries = {entry["file"]: entry for entry in json.loads((BUILD / "compile_commands.json").read_text())}
    known = entries[str(ROOT / newcomer["registry"])]
    made = []
    for name in (newcomer["file"], newcomer["registry"]):
        made.append(objects / (name.replace("/", "_") + ".o"))
        words = shlex.split(known["command"])
        words[words.index("-o") + 1] = str(made[-1])
        words[-1] = str(tree / name)
        run(*words, cwd=known["directory"])
    return made


def linked(target, objects, to):
    """Links a program of the build with these objects in place of those of its libraries."""
    commands = run("ninja", "-C", BUILD, "-t", "commands", target).splitlines()
    words = shlex.split(commands[-1].split(" && ")[1])
    at = words.index("-o") + 1
    words[at:at + 1] = [str(to), *map(str, objects)]
    run(*words, cwd=BUILD)


def come_in(newcomer, tree):
    """One file, and one row at the end of its table."""
    shutil.copy(HERE / pathlib.Path(newcomer["file"]).name, tree / newcomer["file"])
    registry = tree / newcomer["registry"]
    text = registry.read_text()
    start = text.index(newcomer["table"])
    end = text.index("\n  };", start) + 1
    text = text[:end] + newcomer["row"].lstrip("\n") + text[end:]
    first = text.index("namespace cleave {\n") + len("namespace cleave {\n")
    registry.write_text(text[:first] + "\n" + newcomer["declaration"] + "\n" + text[first:])


class DrillTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.directory = tempfile.TemporaryDirectory(prefix="cleave_drill_")
        cls.addClassCleanup(cls.directory.cleanup)
        cls.tree = pathlib.Path(cls.directory.name) / "tree"
        cls.out = pathlib.Path(cls.directory.name) / "out"
        cls.tree.mkdir()
        copy_sources(cls.tree)
        cls.build = pathlib.Path(cls.directory.name) / "build"
        cls.build.mkdir()
        made = {}
        for newcomer in NEWCOMERS:
            come_in(newcomer, cls.tree)
            made[newcomer["file"].split("/")[0]] = compiled(newcomer, cls.tree, cls.build)
        cls.program = cls.build / "cleave"
        linked("cleave", sum(made.values(), []), cls.program)
        linked("tests/partition_tests", made["partition"], cls.build / "partition_tests")
        linked("tests/solver_tests", made["solver"], cls.build / "solver_tests")
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

    def test_nothing_else_was_touched(self):
        """Beside the three files and three registries the copy is the tree."""
        names = run("git", "ls-files", "-z", "harness", "partition", "scenarios", "scripts", "solver", cwd=ROOT).split("\0")
        changed = {name for name in filter(None, names) if (ROOT / name).is_file()
                   and (self.tree / name).read_bytes() != (ROOT / name).read_bytes()}
        self.assertEqual(changed, {newcomer["registry"] for newcomer in NEWCOMERS})
        self.assertEqual(len(NEWCOMERS), 3)

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
        self.script("report", self.out / "run")
        page = "".join(file.read_text(encoding="utf-8") for file in (self.out / "run").rglob("*.html"))
        self.assertIn("stripes", page)

    def test_reproduce_runs_beside_them(self):
        self.script("reproduce", "--steps", "2", "--repeats", "1", "--threads", "1", "--out", self.out / "reproduced",
                    codes=(0, 2, 3))
        tables = list((self.out / "reproduced").rglob("steps.csv"))
        self.assertGreaterEqual(len(tables), 4)

    def test_contract_tests_take_them(self):
        for program, name in (("partition_tests", "stripes"), ("solver_tests", "relax")):
            text = run(self.build / program, f"--gtest_filter=*{name}*")
            self.assertRegex(text, r"\[  PASSED  \] ([5-9]|\d\d) tests")


if __name__ == "__main__":
    unittest.main()
