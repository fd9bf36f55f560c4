"""scripts/ablate_interior_point with stand-ins for the programs it runs, and its tables."""
import csv
import re
import unittest

from stand_in import StandInCase
from synthetic import ROOT

from cleave_scripts.measurements import interior_constants

RECORD = """#!/usr/bin/python3
import os, pathlib, sys
words = sys.argv[1:]
with open(os.environ["STAND_IN_LOG"], "a") as log:
    log.write(" ".join(words) + "\\n")
given = dict(zip(words[1::2], words[2::2]))
out = pathlib.Path(given["--out"])
out.mkdir(parents=True)
for step in given["--at"].split(","):
    (out / f"{given['--scene']}_step{int(step):06}.h5").touch()
"""
# Ten factorisations a problem; one more without `useful`, one fewer without `harmful`, and the last problem is lost
# without `safe`.
BENCHMARK = """#!/usr/bin/python3
import os, sys
words = sys.argv[1:]
with open(os.environ["STAND_IN_LOG"], "a") as log:
    log.write("benchmark " + " ".join(words) + "\\n")
if os.environ["STAND_IN_CODE"] != "0":
    sys.exit("interior_point_benchmark: no")
files = [word for word in words if word.endswith(".h5")]
assert files and all(os.path.exists(file) for file in files), files
print("constant,value,kind,problem,factorizations,proximal,exact,residual_m_per_s")
for constant, value, kind, more in (("-", "-", "default", 0), ("useful", "0", "off", 1), ("harmful", "0", "off", -1),
                                    ("safe", "0", "off", 0), ("shape", "1", "other", 0), ("shape", "4", "other", 1)):
    for file in files:
        lost = constant == "safe" and file == files[-1]
        print(constant, value, kind, file, 10 + more, int(lost), 0 if lost else 1, 1e-3 if lost else 1e-12, sep=",")
"""


class AblateInteriorPointTest(StandInCase):
    script, stand_in = "ablate_interior_point", RECORD

    def setUp(self):
        super().setUp()
        beside = self.directory / "tests" / "interior_point_benchmark"
        beside.parent.mkdir()
        beside.write_text(BENCHMARK)
        beside.chmod(0o755)

    def test_every_scene_is_recorded_at_every_compliance_and_all_is_counted(self):
        result = self.run_it("--scene", "rock_pile_1e6,ladder_loop", "--cfm", "1e-5,0")
        *records, solves = self.calls()
        self.assertEqual(len(records), 4)
        self.assertIn("record --scene rock_pile --at 80,160,240,320 --cfm 1e-5 --mass 1,1000000 ", records[0])
        self.assertEqual(solves.count(".h5"), 16)
        with open(self.directory / "out" / "interior_point.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 6 * 16)
        self.assertEqual(rows[-1]["problem"], "ladder_loop_cfm_0/ladder_loop_step000320.h5")
        self.assertIn("As it is: 160 factorisations over 16 problems, at most 10 of one; 0 proximal, 0 above the limit",
                      result.stdout)
        self.assertIn("| `useful` | off (0): 176 (1.100) |", result.stdout)
        self.assertIn("| `safe` | off (0): 160 (1.000), 1 proximal, 1 above the limit |", result.stdout)
        self.assertIn("| `shape` | 1: 160 (1.000); 4: 176 (1.100) |", result.stdout)
        self.assertTrue(result.stdout.endswith("(less than 0.01 of the factorisations, and no problem): `harmful`.\n"),
                        result.stdout)

    def test_the_constants_asked_for_are_passed_on(self):
        self.run_it("--scene", "log_tower", "--cfm", "0", "--constant", "reach,band")
        self.assertIn("benchmark --constant reach --constant band log_tower_cfm_0/", self.calls()[-1])

    def test_bad_input_and_failures_are_one_line(self):
        self.check_refused((("--scene", "rock_pile,x"), "--scene has 'x', expected one of chain_drop,"),
                           (("--cfm", "1"), "--cfm has '1', expected one of 1e-5,"))
        said = self.run_it("--scene", "log_tower", "--cfm", "0", code=1, stand_in_code=1).stderr.splitlines()
        self.assertIn("exit code 1: interior_point_benchmark: no", said[-1])
        self.assertFalse((self.directory / "out" / "interior_point.csv").exists())


class DocumentTest(unittest.TestCase):

    def setUp(self):
        self.header = (ROOT / "solver" / "strategies" / "interior_constants.h").read_text()
        section = (ROOT / "solver" / "README.md").read_text().partition("## The interior point's constants")[2]
        self.rows = dict(re.findall(r"^\| `(\w+)` \| (.*) \|$", section.partition("\n## ")[0], re.M))

    def test_the_readme_lists_every_constant_of_the_struct(self):
        self.assertEqual(list(self.rows), re.findall(r"^  (?:double|int) (\w+) = ", self.header, re.M))

    def test_header_and_readme_give_the_same_counts(self):
        found = re.findall(r"  // ((?:off|[\d.e-]+)[ :].*)\.\n  (?:double|int) (\w+) = ", self.header)
        without_change = {name: re.sub(r" \([\d.]+\)(?=[,;]|$)", "", text) for name, text in self.rows.items()}
        self.assertEqual({name: counts for counts, name in found}, without_change)


class TotalsTest(unittest.TestCase):

    def test_without_an_off_value_every_value_that_was_tried_counts(self):
        lines = ["constant,value,kind,problem,factorizations,proximal,exact,residual_m_per_s", "-,-,default,p,1000,0,1,0"]
        lines += [f"{name},{value},other,p,{count},0,1,0"
                  for name, value, count in (("a", 1, 1009), ("a", 2, 1010), ("b", 1, 1009), ("b", 2, 900))]
        self.assertEqual(interior_constants.buying_nothing(interior_constants.totals("\n".join(lines))), ["b"])


if __name__ == "__main__":
    unittest.main()
