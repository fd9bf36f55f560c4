"""What the campaigns under scripts/data/campaigns expand to, held against what scripts run and what the paper says."""
import csv
import io
import pathlib
import subprocess
import tempfile
import unittest

from synthetic import PROGRAM, SCRIPTS

from cleave_scripts.ladder.climbers import CLIMBERS
from cleave_scripts.ladder.rungs import RUNGS
from cleave_scripts.results.paper import PARTITIONERS as PAPERS_PARTITIONERS
from cleave_scripts.results.paper import REFINERS, SCENES

FOLDER = SCRIPTS / "data" / "campaigns"
DEFAULTS = {"friction": "box", "dt": 1 / 60, "cfm": 1e-5, "erp": 0.2, "mu": 0.5, "copies": 1, "contact-cap": 8}


def sweep(*words):
    return subprocess.run([PROGRAM, "sweep", *map(str, words)], capture_output=True, text=True, timeout=600, check=False)


def options_of(arguments):
    pairs = (word.removeprefix("--").partition("=") for word in arguments.split(" "))
    return {name: value or True for name, _, value in pairs}


def cells(name):
    """Options of every cell."""
    printed = sweep(FOLDER / f"{name}.toml", "--dry-run", "--out", "/nonexistent")
    assert printed.returncode == 0, printed.stderr
    return [options_of(row["arguments"]) for row in csv.DictReader(io.StringIO(printed.stdout))]


def key(options):
    """Equal for two texts of the same numbers, and where a default is given or not."""
    values = {}
    for name, value in options.items():
        try:
            values[name] = float(value)
        except ValueError:
            values[name] = value
    return frozenset((name, value) for name, value in values.items() if DEFAULTS.get(name) != value)


class CampaignsTest(unittest.TestCase):

    def test_every_campaign_is_tested_here(self):
        self.assertEqual({path.stem for path in FOLDER.iterdir()},
                         {"extremes", "hidden-choices", "ladder", "paper", "report", "scaling", "smoke"})

    def test_paper_is_its_table_1(self):
        found = cells("paper")
        self.assertEqual([cell["scene"] for cell in found], list(SCENES))
        for cell in found:
            self.assertEqual((cell["partitioner"], cell["refiner"], cell["solver"], cell["steps"]),
                             (",".join(PAPERS_PARTITIONERS), ",".join(REFINERS), "schur", "500"))

    def test_scaling_has_the_sizes_of_the_script_in_rounds(self):
        found = cells("scaling")
        self.assertEqual([int(cell["bodies"]) for cell in found], 3 * [50, 100, 200, 400, 600, 800])
        for cell in found:
            self.assertEqual((cell["partitioner"], cell["refiner"], cell["scene"]),
                             ("mindp,mix", ",".join(REFINERS), "rock_pile"))

    def test_ladder_has_every_value_of_every_rung_and_every_climber(self):
        same = {"mode": "separate", "partitioner": "mindp", "refiner": "none", "steps": "600", "repeats": "1"}
        wanted = {
            key({**same, "solver": climber.solver, "friction": climber.friction, **rung.settings(value)})
            for rung in RUNGS for value in rung.values for climber in CLIMBERS.values()
        }
        found = [key(cell) for cell in cells("ladder")]
        self.assertEqual(set(found), wanted)
        self.assertEqual(len(found), len(wanted))
        self.assertGreater(len(wanted), 1000)

    def test_report_has_every_solver_on_the_same_rocks_and_motion_of_three_scenes(self):
        found = cells("report")
        rocks = [cell for cell in found if cell.get("bodies") == "200"]
        self.assertEqual(sorted((cell["solver"], cell.get("sweeps", cell.get("quickstep-iterations", "-"))) for cell in rocks),
                         sorted([("exact,monolithic,schur", "-"), ("schur", "-"),
                                 *(("pgs", str(n)) for n in (10, 30, 100, 300, 1000, 3000)),
                                 *(("ode-quickstep", str(n)) for n in (20, 200, 2000))]))
        self.assertEqual([cell["scene"] for cell in found if "record-motion" in cell], ["chain_drop", "log_tower", "rock_pile"])
        self.assertEqual({cell["threads"] for cell in found if "bodies" in cell}, {"1"})

    def test_extremes_meets_every_mass_ratio_with_every_compliance(self):
        found = cells("extremes")
        self.assertEqual(len(found), 10 * 7 * 3)
        self.assertEqual({cell["solver"] for cell in found}, {"interior-point:monolithic"})
        self.assertEqual({cell["cfm"] for cell in found}, {"1e-4", "1e-6", "1e-8", "1e-10", "1e-12", "1e-14", "0"})

    def test_hidden_choices_has_every_choice_that_the_paper_leaves_open(self):
        found = cells("hidden-choices")
        self.assertEqual(len(found), 4 * 8 * 4 + 3 * 6 + 16)
        self.assertEqual({cell["scene"] for cell in found}, set(SCENES))
        self.assertEqual({int(cell["max-bodies"]) for cell in found}, {10, 15, 20, 25, 35, 50, 75, 100})
        self.assertEqual({cell["body-order"] for cell in found}, {"scene", *(f"random@seed={seed}" for seed in (1, 2, 3))})
        self.assertEqual({(cell.get("logs", "5"), cell.get("layers", "40")) for cell in found},
                         {("4", "50"), ("5", "40"), ("8", "25"), ("10", "20")})
        for cell in found:
            self.assertIn("bfs,bfs@restart=graph,mr,mr@tau-mr=10.5,", cell["partitioner"])
        self.assertEqual(sum(cell["repeats"] == "3" for cell in found), 12)
        self.assertEqual(sum(cell["solver"] == "schur" for cell in found), 16)

    def test_the_example_of_the_documents_is_a_campaign(self):
        text = (SCRIPTS.parent / "harness" / "README.md").read_text().partition("\n## Campaigns\n")[2]
        example = text.partition("\n    ")[2].partition("\n\n")[0]
        with tempfile.TemporaryDirectory() as directory:
            spec = pathlib.Path(directory) / "example.toml"
            spec.write_text(example)
            printed = sweep(spec, "--dry-run", "--out", pathlib.Path(directory) / "out")
        self.assertEqual(printed.returncode, 0, printed.stderr)
        # Three sizes at four compliances less two, and the one that is included, three times over.
        self.assertEqual(len(list(csv.DictReader(io.StringIO(printed.stdout)))), 3 * (3 * 4 - 2 + 1))

    def test_smoke_runs_and_its_results_verify(self):
        with tempfile.TemporaryDirectory() as scratch:
            out = pathlib.Path(scratch) / "smoke"
            result = sweep(FOLDER / "smoke.toml", "--out", out)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn("4 cells: 4 ok; 0 kept", result.stderr)
            verified = subprocess.run([PROGRAM, "verify", out], capture_output=True, text=True, timeout=600, check=False)
            self.assertEqual(verified.returncode, 0, verified.stdout)


if __name__ == "__main__":
    unittest.main()
