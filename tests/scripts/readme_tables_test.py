"""scripts/readme_tables: the READMEs say what the files under results/ say."""
import pathlib
import re
import tempfile
import unittest

import stored_data
from synthetic import ROOT, SCRIPTS, run_script, write_manifest

from cleave_scripts.documents import (accuracy, campaigns, cuts, friction, hidden, large, markers, modelled_cost, paper_claims,
                                      paper_table, peers, sets, speed, stability, worth)
from cleave_scripts.documents.stored import NoResults, Stored
from cleave_scripts.measurements import (builds, coulomb_beside_siconos, elimination_orders, extremes_steps,
                                         friction_bounds, friction_cost, friction_forms, large_scenes, objectives,
                                         partition_worth, peer_times, running_simulation)
from cleave_scripts.measurements.reference_stages import STAGES
from cleave_scripts.results.errors import ResultError
from cleave_scripts.table import text

DOCUMENTS = ("README.md", "partition/README.md", "solver/README.md", "harness/README.md", "harness/peers/README.md",
             "results/README.md", "results/table1.md")
MEASURED = re.compile(r"\d ?(?:ms|µs|us|%|Gflop/s)\b|\d %")


class CheckoutTest(unittest.TestCase):

    def test_the_readmes_of_this_checkout_agree_with_the_files(self):
        result = run_script("readme_tables", "--check")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def test_every_part_stands_in_a_document_and_every_document_has_one(self):
        found = [markers.names((ROOT / name).read_text()) for name in DOCUMENTS]
        modules = (accuracy, campaigns, cuts, friction, hidden, large, modelled_cost, paper_claims, paper_table, peers, sets,
                   speed, stability, worth)
        self.assertEqual(sorted(sum(found, [])), sorted(name for module in modules for name in module.BLOCKS))
        self.assertTrue(all(found))

    def test_the_commands_told_are_those_that_remake_the_set(self):
        commands = {"scripts/" + (" ".join(stage.command).partition(" --out ")[0]
                                  .replace("{report}/", "out/report/").replace(" {report}", ""))
                    for stage in STAGES if stage.runs or stage.files}
        self.assertEqual({command for _, command in sets.SETS.values()}, commands)

    def test_a_set_is_told_with_the_command_that_made_it(self):
        class Known:
            @staticmethod
            def provenance():
                return {"karger.csv": {"command": "scripts/karger --out out/karger --trials 3"},
                        "report/verdicts.csv": {"command": "scripts/report out/report"},
                        "figures/a.png": {"command": "scripts/readme_figures --out out/figures out/report"}}
        self.assertEqual(sets.command_of(Known, "karger.csv"), "scripts/karger --trials 3")
        self.assertEqual(sets.command_of(Known, "figures"), "scripts/readme_figures out/report")
        self.assertEqual(sets.command_of(Known, "ablation.csv"), "scripts/ablation")
        self.assertEqual(sets.command_of(Known, "report"), "scripts/report_runs --measure-every 25")
        self.assertEqual(sets.command_of(Known, "report/verdicts.csv"), "scripts/report out/report")

    def test_every_file_of_the_set_is_explained(self):
        text = (ROOT / "results" / "README.md").read_text()
        rows = {name: line for line in text.splitlines() if line.startswith("| `")
                for name in re.findall(r"`([^`]+)`", line.split("|")[1])}
        for name in sets.SETS:
            if name.startswith("ladder/"):
                self.assertIn("\n## ladder.csv\n", text)
            elif name.endswith((".csv", ".json")):
                self.assertIn(name, rows)
        for name, columns in self.columns().items():
            self.assertEqual(columns - set(re.findall(r"`(\w+)`", rows[name])), set(), name)

    def columns(self):
        """{small CSV file: its columns} as the commands write them."""
        written = {"extremes.csv": set(extremes_steps.WRITTEN), "running_simulation.csv": set(running_simulation.COLUMNS),
                   "large_scenes.csv": set(large_scenes.COLUMNS), "friction_cost.csv": set(friction_cost.COLUMNS),
                   "friction_bounds.csv": set(friction_bounds.COLUMNS), "friction_forms.csv": set(friction_forms.COLUMNS),
                   "coulomb_peers.csv": set(coulomb_beside_siconos.COLUMNS),
                   "partition_objectives.csv": set(objectives.COLUMNS),
                   "elimination_orders.csv": set(elimination_orders.COLUMNS), "compare_builds.csv": set(builds.COLUMNS),
                   "partition_worth.csv": set(partition_worth.COLUMNS), "peer_times.csv": set(peer_times.COLUMNS)}
        for command in ("two_threads", "modelled_workers", "busy_machine", "idle_cost", "cold_starts", "karger",
                        "partition_over_time", "ablation"):
            listed = re.search(r"^COLUMNS = \((.*?)\)", (SCRIPTS / command).read_text(), re.M | re.S)[1]
            written[f"{command}.csv"] = set(re.findall(r'"(\w+)"', listed))
        with open(ROOT / "results" / "report" / "verdicts.csv", encoding="utf-8") as file:
            written["report/verdicts.csv"] = set(file.readline().strip().split(","))
        return written

    def test_no_measured_number_stands_outside_of_the_generated_parts(self):
        for name in DOCUMENTS:
            prose = re.sub(r"```.*?```", "", markers.outside((ROOT / name).read_text()), flags=re.S)
            self.assertEqual(MEASURED.findall(prose), [], name)


# Parts that a small set of results is enough for.
PARTS = {"README.md": ("excerpt", "table1_facts", "two_threads"), "results/table1.md": ("table1",)}


class RewriteTest(unittest.TestCase):

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.root = pathlib.Path(scratch.name)
        for name in DOCUMENTS:
            (self.root / name).parent.mkdir(exist_ok=True)
            parts = PARTS.get(name, ())
            (self.root / name).write_text("".join(f"<!-- generated: {part} -->\n<!-- end -->\n" for part in parts))
        stored_data.full(self.root / "results")
        stored_data.two_threads(self.root / "results")
        stored_data.write_provenance(self.root / "results", "full", "two_threads.csv")
        self.run_it()

    def run_it(self, *arguments, code=0):
        result = run_script("readme_tables", "--root", self.root, *arguments)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result.stdout + result.stderr

    def test_a_number_changed_by_hand_is_found_and_put_right(self):
        path = self.root / "README.md"
        right = path.read_text()
        path.write_text(right.replace("rows are exact: their largest", "rows are very exact: their largest"))
        self.assertIn("README.md: differs", self.run_it("--check", code=3))
        self.assertNotEqual(path.read_text(), right)
        self.assertEqual(self.run_it(), "README.md: written\n")
        self.assertEqual(path.read_text(), right)
        self.assertEqual(self.run_it("--check"), "")

    def test_a_changed_result_is_found_in_every_document_that_tells_it(self):
        path = self.root / "results" / "full" / "rock_pile" / "steps.csv"
        lines = path.read_text().splitlines()
        column = lines[0].split(",").index("t_s_ms")
        for number, line in enumerate(lines[1:], 1):
            cells = line.split(",")
            lines[number] = ",".join([*cells[:column], "1234.5", *cells[column + 1:]])
        path.write_text("\n".join(lines) + "\n")
        said = self.run_it("--check", code=3)
        for name in ("README.md", "results/table1.md"):
            self.assertIn(f"{name}: differs", said)
        self.run_it()
        self.assertIn("1234.5", (self.root / "README.md").read_text())

    def test_check_names_what_is_not_stored_and_what_nobody_knows_the_origin_of(self):
        (self.root / "results" / "provenance.json").unlink()
        self.run_it()
        said = self.run_it("--check", code=3)
        for name in ("full", "two_threads.csv"):
            self.assertIn(f"results/{name}: machine and commit not recorded\n", said)
        (self.root / "results" / "two_threads.csv").unlink()
        self.run_it()
        self.assertIn("results/two_threads.csv: not stored, scripts/two_threads makes it\n", self.run_it("--check", code=3))

    def test_check_names_runs_that_are_not_whole_and_builds_with_local_changes(self):
        run = self.root / "results" / "full" / "rock_pile"
        write_manifest(run, state="interrupted", build=stored_data.BUILD, machine=stored_data.MACHINE)
        path = run / "steps.csv"
        path.write_text(path.read_text() + "1,2")
        self.run_it()
        self.assertIn("results/full/rock_pile/steps.csv: the last line was not finished and is left out; "
                      "not all steps are there, the state of the run is interrupted\n", self.run_it("--check", code=3))
        path.write_text(path.read_text().removesuffix("1,2"))
        for dirty in ("true", "unknown"):
            write_manifest(run, state="complete", build=stored_data.BUILD | {"git_dirty": dirty}, machine=stored_data.MACHINE)
            self.run_it()
            self.assertEqual(self.run_it("--check", code=3),
                             "results/full: made by a build with local changes or without a commit\n")

    def test_bad_places_are_one_line(self):
        path = self.root / "README.md"
        right = path.read_text()
        for spoiled, words in ((right.replace("generated: excerpt", "generated: extract"), "nothing makes 'extract'"),
                               (right.replace("<!-- end -->", "", 1), "does not begin or does not end")):
            path.write_text(spoiled)
            said = self.run_it(code=1)
            self.assertIn(words, said)
            self.assertEqual(len(said.splitlines()), 1)


class BlocksTest(unittest.TestCase):
    """The parts from made-up results with known answers."""

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.root = pathlib.Path(scratch.name)

    @property
    def stored(self):
        return Stored(self.root)

    def test_what_is_not_stored_says_what_makes_it(self):
        with self.assertRaisesRegex(NoResults, "`scripts/two_threads` makes `results/two_threads.csv`"):
            speed.two_threads(self.stored)

    def test_sets_that_are_not_stored_or_of_unknown_origin_are_gaps(self):
        stored_data.two_threads(self.root)
        stored_data.cold_starts(self.root)
        stored_data.write_provenance(self.root, "two_threads.csv")
        stored = self.stored
        made = sets.reference_sets(stored)
        self.assertIn("| 1.5 min | Some CPU, 2 cores, commit 0123456789 |", made)
        self.assertEqual(set(stored.gaps), set(sets.SETS) - {"two_threads.csv"})
        self.assertEqual(stored.gaps["cold_starts.csv"], "machine and commit not recorded")

    def test_the_excerpt_ends_with_what_was_checked(self):
        stored_data.full(self.root)
        made = paper_table.excerpt(self.stored)
        self.assertIn("\n\npass  every row has status ok\npass  residual within the limit of an exact answer\n...\n"
                      "600 rows checked\n```", made)
        stored_data.full(self.root, "not_converged")
        self.assertIn("\nFAIL  every row has status ok; 1 found, first: ", paper_table.excerpt(self.stored))

    def test_the_model_is_held_against_what_was_measured_without_a_wait(self):
        stored_data.full(self.root)
        stored_data.one_thread(self.root)
        made = speed.model(self.stored)
        self.assertIn("| Rock Pile | 150 | 0.500 | 0.500 | 0.500 |", made)
        self.assertIn("; 0 pairs that waited", made)
        stored_data.one_thread(self.root, waiting_ms=0.6)  # of 10
        made = speed.model(self.stored)
        self.assertIn("| Rock Pile | 149 | 0.500 | 0.500 | 0.500 |", made)
        self.assertIn("; 1 pairs that waited", made)

    def test_table1_facts_name_the_lowest_the_failed_and_the_stalls(self):
        stored_data.full(self.root)
        made = paper_table.table1_facts(self.stored)
        self.assertIn("| Rock Pile | bfs+fm, 1.12 | mix+fm, 79.6 | ", made)
        self.assertIn("All 600 rows are exact: their largest residual is 1.0e-12 m/s", made)
        self.assertIn("50 % of the rows of Rock Pile", made)
        self.assertIn("0 % of the rows of Chain Drop", made)
        stored_data.full(self.root, "not_converged")
        self.assertIn("599 of 600 rows are exact", paper_table.table1_facts(self.stored))
        self.assertIn("1 of 10 steps failed", paper_table.table1(self.stored))

    def test_speed_and_accuracy_are_those_of_the_fastest_direct_solver_and_of_finite_rows(self):
        stored_data.solver_runs(self.root)
        made = speed.speed_accuracy(self.stored)
        self.assertIn("`monolithic` solves a step exactly in 4.00 ms", made)
        self.assertIn("| 10 | 1.00 | 0.250 | 0.100 |\n| 100 | 10.0 | 2.50 | 0.0100 |", made)

    def test_two_threads_are_shares_of_the_ceiling(self):
        stored_data.two_threads(self.root)
        stored_data.write_provenance(self.root, "two_threads.csv")
        made = speed.two_threads(self.stored)
        self.assertIn("| rocks | cfm | `exact` | `pivot:schur-bodies` |\n| --- | --- | --- | --- |\n"
                      "| 200 | 1e-05 | - (1.60 of 1.60) | 1.00 (2.00 of 2.00) |\n"
                      "| 200 | 1e-10 | 0.75 (1.50 of 2.00) | 0.80 (1.50 of 1.88) |\n", made)
        self.assertIn("| step | least share | below 0.8 | measured | combinations |\n| --- | --- | --- | --- | --- |\n"
                      "| 100 | `mix+none` 0.90 (1.80 of 2.00) | 0 | 2 | 3 |\n"
                      "| 300 | `mix+none` 0.90 (1.80 of 2.00) | 0 | 2 | 3 |", made)
        self.assertNotIn("Solvers that iterate", made)
        self.assertIn("Medians of 3 rounds", made)
        self.assertIn("Some CPU, 2 cores, commit 0123456789", made)

    def test_two_threads_of_an_older_form_are_an_error(self):
        stored_data.write_csv(self.root / "two_threads.csv", [{"step": 100, "threads": 1, "t_s_ms": 1}])
        with self.assertRaisesRegex(ResultError, "no column processes; scripts/reference makes them anew"):
            speed.two_threads(self.stored)

    def test_cold_starts_count_large_steps_alone(self):
        stored_data.cold_starts(self.root)
        made = speed.cold_starts(self.stored)
        self.assertIn("the 4 recorded steps", made)
        self.assertIn("cold: median 9, at most 12, and at most 8 on 2; warm: median 3, at most 3, and at most 8 on 4", made)

    def test_extremes_tell_failures_where_there_are_any(self):
        stored_data.extremes(self.root)
        made = stability.extremes(self.stored)
        self.assertIn("| 1e6 | rock_pile | 3 | 25 / 30 | 90 / 90 |", made)
        self.assertIn("All steps were solved; at most 30 factorisations (asked: 40) at mass ratios up to 1e3", made)
        self.assertIn("at most 90 without any compliance", made)
        self.assertIn("fails on none, in at most 30", stability.extremes_sentence(self.stored))
        stored_data.extremes(self.root, "not_converged")
        self.assertIn("1 of 6 steps were not solved", stability.extremes(self.stored))
        self.assertIn("fails on 1,", stability.extremes_sentence(self.stored))

    def test_the_ladder_counts_and_does_not_boast(self):
        stored_data.ladder(self.root)
        made = stability.ladder(self.stored)
        self.assertIn("| `pgs_20` | 2 of 2 | 1 of 1 | 1 of 1 | 0 of 2 | 0 of 1 | 0 of 1 |", made)
        self.assertIn("| `ode-step_pyramid` | - | - | - | 2 of 2 | 1 of 1 | 0 of 1 |", made)
        self.assertIn("Whether `ode-step_pyramid` is exact is not judged", made)
        self.assertIn("not right on `chain_swing` at mass-ratio 100 (`step_too_long`). Where `physics` is", made)
        made = stability.ladder_full(self.stored)
        self.assertIn("`exact` solves all 4 values", made)
        self.assertIn("within 0.0060 mm of the closed form, in which the compliance lets them sag 0.12 mm", made)
        stored_data.ladder(self.root, "not_converged")
        self.assertIn("`exact` solves 3 of 4 values", stability.ladder_full(self.stored))
        stored_data.ladder(self.root, swing="ok")
        self.assertIn("With `exact` the motion is right on every value.", stability.ladder(self.stored))

    def test_a_ladder_without_its_set_ups_is_an_error(self):
        stored_data.write_csv(self.root / "ladder" / "ladder.csv", [{"rung": "a", "solver": "exact", "status": "ok"}])
        with self.assertRaisesRegex(ResultError, "no column setup"):
            stability.ladder(self.stored)

    def test_the_ablation_shows_what_differs_from_the_default(self):
        stored_data.ablation(self.root)
        self.assertIn("| mindp+none | 100 | 150 |  |  |  |", cuts.ablation(self.stored))
        self.assertIn("| degree whole | `mindp+none` | +50 % |", cuts.ablation_facts(self.stored))

    def test_partition_speed(self):
        stored_data.partition_benchmark(self.root)
        told = cuts.partition_speed(self.stored)
        self.assertIn("| pile 200: 200 bodies, 353 edges | 2469 | ", told)
        self.assertIn("| pile 1000 | 500 | ", told)
        told = cuts.partition_ratios(self.stored)
        self.assertIn("| multilevel, best | 0.800 | 0.800 (pile 200) | 8.10 | 8.10 | 1.00 |", told)
        self.assertIn("| mindp+none | 1.06 | 1.20 (pile 200) | 8.10 | 8.10 | 1.00 |", told)

    def test_karger(self):
        stored_data.karger(self.root)
        self.assertIn("| Rock Pile | 40 / 1.00 | 50 / 1.00 | 50 / 1.00 | 45 / 1.00 | 40 / 1.00 | 35 / 1.00 | 20 / 1.00 | "
                      "90 / 1.00 | 10000 | 100 | 41.0 | 21.0 |", cuts.karger(self.stored))

    def test_over_time(self):
        stored_data.partition_over_time(self.root)
        self.assertIn("| rock pile, mix+fm | 0.100 | 4.00, 0.950, 1.20 (0 / 50 / 50) | 1.00, 1.00, 1.00 (100 / 0 / 0) |",
                      worth.over_time(self.stored))

    def test_rows_that_are_missing_are_an_error(self):
        (self.root / "two_threads.csv").write_text("step,t_s_ms\n")
        with self.assertRaises(ResultError):
            speed.two_threads(self.stored)


class TextTest(unittest.TestCase):

    def test_numbers(self):
        self.assertEqual([text.number(value) for value in (0, 0.01234, 4.5678, 789.4, 12345.6, 1.234e-13, float("nan"))],
                         ["0", "0.0123", "4.57", "789", "12346", "1.2e-13", "-"])
        self.assertEqual([text.percent(share) for share in (0.456, -0.001, float("nan"))], ["46 %", "0 %", "-"])

    def test_lists(self):
        self.assertEqual([text.listed(words) for words in ((), "a", "ab", "abc")], ["none", "a", "a and b", "a, b and c"])


if __name__ == "__main__":
    unittest.main()
