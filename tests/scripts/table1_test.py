"""Table 1 from made-up results: means, marks, ratios, failed rows, gaps and error messages."""
import csv
import io
import pathlib
import re
import tempfile
import unittest

from synthetic import COMBINATIONS, good_row, matrix, run_script, write_manifest, write_matrix, write_steps

from cleave_scripts.results.paper import SCENES, load_paper_table1

MANIFEST = {
    "options": {
        "threads": 2
    },
    "build": {
        "git_hash": "0123456789abcdef",
        "git_dirty": "true"
    },
    "machine": {
        "cpu_model": "Some_CPU @ 3 GHz",
        "cores": 6
    }
}
MACHINE = "Ours: Some_CPU @ 3 GHz, 6 cores, 2 threads, commit 0123456789 with local changes."


class Table1Test(unittest.TestCase):

    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)
        self.directory = pathlib.Path(self.scratch.name)

    def table(self, *arguments, code=0):
        result = run_script("table1", self.directory, *arguments)
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertNotIn("Traceback", result.stderr)
        return result.stdout if code == 0 else result.stderr

    def cells(self, *arguments):
        text = self.table("--format", "csv", *arguments)
        lines = [line for line in text.splitlines() if not line.startswith("#")]
        return {(row["scene"], row["partitioner"], row["refiner"]): row for row in csv.DictReader(lines)}


class MeansTest(Table1Test):

    def test_mean_ratio_and_marks(self):
        rows = [
            dict(good_row("rock_pile", 0, "mindp", "none"), t_s_ms=20, t_pr_ms=1),
            dict(good_row("rock_pile", 50, "mindp", "none"), t_s_ms=40, t_pr_ms=2),
            dict(good_row("rock_pile", 0, "mix", "fm"), t_s_ms=27, t_pr_ms=4),
            dict(good_row("rock_pile", 50, "mix", "fm"), t_s_ms=30, t_pr_ms=4)
        ]
        write_steps(self.directory, rows)
        cells = self.cells()
        self.assertEqual(list(cells), [("rock_pile", "mindp", "none"), ("rock_pile", "mix", "fm")])
        cell = cells["rock_pile", "mindp", "none"]
        self.assertEqual([float(cell[name]) for name in ("t_s_ms", "t_pr_ms", "total_ms")], [30, 1.5, 31.5])
        self.assertEqual([float(cell[name]) for name in ("paper_t_s_ms", "paper_t_pr_ms")], [144.5, 1.2])
        self.assertAlmostEqual(float(cell["ratio_t_s"]), 30 / 144.5, 5)
        self.assertAlmostEqual(float(cell["ratio_t_pr"]), 1.5 / 1.2, 5)
        self.assertAlmostEqual(float(cell["ratio_total"]), 31.5 / 145.7, 5)
        # mix fm solves faster, but its total is greater.
        self.assertEqual([name for name in cells if cells[name]["lowest"] == "1"],
                         [("rock_pile", "mindp", "none")])
        self.assertEqual([name for name in cells if cells[name]["paper_lowest"] == "1"],
                         [("rock_pile", "mix", "fm")])

    def test_all_four_scenes_in_the_papers_order(self):
        write_matrix(self.directory)
        cells = self.cells()
        self.assertEqual(list(cells), [(scene, *names) for scene in SCENES for names in COMBINATIONS])
        paper = load_paper_table1()
        for key, cell in cells.items():
            self.assertEqual((float(cell["paper_t_s_ms"]), float(cell["paper_t_pr_ms"])), paper[key])
            self.assertEqual(float(cell["t_s_ms"]), 10 + COMBINATIONS.index(key[1:]))
            self.assertEqual(cell["steps_ok"], "10")

    def test_failed_rows_are_counted_not_averaged_and_cannot_win(self):
        rows = matrix("rock_pile", [0, 50])
        rows[15].update(status="not_converged", t_s_ms="nan")  # mindp none, the fastest, at step 50
        write_steps(self.directory, rows)
        cells = self.cells()
        cell = cells["rock_pile", "mindp", "none"]
        self.assertEqual((cell["t_s_ms"], cell["steps_ok"], cell["steps_failed"], cell["lowest"]),
                         ("10", "1", "1", "0"))
        self.assertEqual(cells["rock_pile", "mindp", "kl"]["lowest"], "1")
        text = self.table()
        self.assertIn("1 failed row (status not ok)", text)
        self.assertIn("! 1 of 2 steps failed: mindp none", text)

    def test_steps_without_a_row_are_counted_and_combinations_without_any_are_not_there(self):
        rows = [row for row in matrix("rock_pile", [0, 50]) if row["partitioner"] != "mix"]
        write_steps(self.directory, [row for row in rows if row["partitioner"] != "mr" or row["step"] == 0])
        cells = self.cells()
        self.assertEqual(len(cells), 12)
        self.assertEqual({cell["paper_lowest"] for cell in cells.values()}, {"0"})  # mix fm, which is not there
        self.assertEqual(cells["rock_pile", "mr", "kl"]["steps_missing"], "1")
        line = next(line for line in self.table().splitlines() if line.startswith("mr     kl"))
        self.assertTrue(line.endswith("!"), line)
        self.assertIn("! 1 of 2 steps missing: mr none, mr kl, mr fm", self.table())

    def test_all_that_failed_is_a_gap(self):
        write_steps(self.directory, [row | {"status": "diverged" if row["partitioner"] == "mr" else "ok"}
                                     for row in matrix("rock_pile", [0])])
        line = next(line for line in self.table().splitlines() if line.startswith("mr     kl"))
        self.assertRegex(line, r"\|\s+-\s+-\s+- .*!$")

    def test_rows_of_a_solver_without_partition_are_left_out(self):
        write_steps(
            self.directory,
            matrix("rock_pile", [0]) + [
                dict(good_row("rock_pile", 0, "mix", "fm"),
                     partitioner="-",
                     refiner="-",
                     solver="dense",
                     t_s_ms=1)
            ])
        self.assertEqual(len(self.cells()), len(COMBINATIONS))

    def test_a_scene_and_a_partitioner_the_paper_does_not_have(self):
        write_steps(self.directory, [
            dict(row,
                 scene="ladder",
                 partitioner="metis" if row["partitioner"] == "mix" else row["partitioner"])
            for row in matrix("rock_pile", [0])
        ])
        cells = self.cells()
        self.assertEqual(
            (cells["ladder", "metis", "fm"]["t_s_ms"], cells["ladder", "metis", "fm"]["paper_t_s_ms"]), ("24", ""))
        self.assertNotIn(("ladder", "mix", "fm"), cells)


class ChoiceTest(Table1Test):

    def test_mixed_rows_are_refused_until_one_kind_is_chosen(self):
        write_steps(
            self.directory,
            matrix("rock_pile", [0]) + [dict(row, threads=1, t_s_ms=99) for row in matrix("rock_pile", [0])])
        self.assertIn("mix threads 1, 2; choose one with --where threads=1", self.table(code=1))
        self.assertEqual(self.cells("--where", "threads=1")["rock_pile", "bfs", "kl"]["t_s_ms"], "99")
        self.assertIn("no measured rows", self.table("--where", "threads=8", code=1))
        self.assertIn("no column color", self.table("--where", "color=red", code=1))

    def test_times_of_two_processors_are_not_averaged(self):
        for seed, model in ((1, "A"), (2, "B")):
            write_steps(self.directory / str(seed), [dict(row, seed=seed, t_s_ms=seed) for row in matrix("rock_pile", [0])])
            write_manifest(self.directory / str(seed), machine={"cpu_model": model, "cores": 2})
        self.assertIn("mix machine A, B; choose one with --where machine=A", self.table(code=1))
        self.assertEqual(self.cells("--where", "machine=B")["rock_pile", "bfs", "kl"]["t_s_ms"], "2")

    def test_a_step_given_twice_is_refused(self):
        for name in ("a", "b"):
            write_steps(self.directory / name, matrix("rock_pile", [0]))
        self.assertRegex(self.table(code=1), r"b/steps.csv, line 2: step 0 of rock_pile.*a/steps.csv, line 2")

    def test_seeds_are_averaged(self):
        for seed in (1, 2):
            write_steps(self.directory / str(seed),
                        [dict(row, seed=seed, t_s_ms=seed) for row in matrix("rock_pile", [0])])
        cell = self.cells()["rock_pile", "mr", "fm"]
        self.assertEqual((cell["t_s_ms"], cell["steps_ok"]), ("1.5", "2"))


class ComparisonTest(Table1Test):

    def test_runs_of_the_papers_size_need_no_word(self):
        write_matrix(self.directory)
        for format in ("text", "markdown", "latex", "csv"):
            self.assertNotIn("not the paper's run", self.table("--format", format))

    def test_another_size_or_number_of_steps_is_said_below_the_scene(self):
        for scene, changes, words in (("rock_pile", {"bodies": 50}, "50 bodies (paper 200)"),
                                      ("log_tower", {"steps": 60}, "60 steps (paper 500)")):
            write_steps(self.directory / scene, [row | changes for row in matrix(scene, [0])])
            title = scene.replace("_", " ").title()
            for format in ("text", "markdown", "csv"):
                self.assertIn(f"{title} is not the paper's run: {words}", self.table("--format", format))
            self.assertIn(words, self.table("--format", "latex"))
        text = self.table()
        self.assertLess(text.index("Log Tower is not"), text.index("\nRock Pile: "))

    def test_files_that_do_not_say_how_many_steps_are_not_taken_for_the_papers(self):
        rows = matrix("rock_pile", [0])
        for row in rows:
            del row["steps"]
        write_steps(self.directory, rows)
        self.assertIn("unknown steps (paper 500)", self.table())

    def test_a_scene_that_the_paper_does_not_have_is_not_compared(self):
        rows = matrix("rock_pile", [0])
        write_steps(self.directory, [row | {"scene": "ladder", "steps": 3} for row in rows])
        self.assertNotIn("not the paper's run", self.table())

    def test_rows_of_other_parameters_are_not_averaged(self):
        for column, one, other in (("cfm", "1e-05", "1e-06"), ("contact_cap", 8, 4), ("max_iterations", 9, 100),
                                   ("scene_options", "bodies=200", "bodies=300"), ("mode", "lockstep", "separate"),
                                   ("advance", "exact", "pgs"), ("steps", 500, 60)):
            rows = [row | {column: one} for row in matrix("rock_pile", [0])]
            rows += [row | {column: other} for row in matrix("rock_pile", [50])]
            write_steps(self.directory, rows)
            self.assertIn(f"mix {column} ", self.table(code=1))

    def test_a_solver_that_hands_over_stays_one_solver(self):
        write_steps(self.directory,
                    [row | {"strategy": name, "kernel": name} for name, step in (("pivot", 0), ("interior-point", 50))
                     for row in matrix("rock_pile", [step])])
        # As manifests of some builds have it; what ran at the end is measured.
        write_manifest(self.directory, columns=[{"name": name, "about": "solver"} for name in ("strategy", "kernel")])
        self.assertIn("Rock Pile: 2 measured steps", self.table())

    def test_rows_that_do_not_say_a_parameter_are_not_averaged_with_those_that_do(self):
        write_steps(self.directory / "a", matrix("rock_pile", [0]))
        write_steps(self.directory / "b", [row | {"advance": "exact"} for row in matrix("rock_pile", [50])])
        self.assertIn("mix advance exact, unknown; choose one with --where advance=exact", self.table(code=1))

    def test_cells_whose_solves_waited_for_a_core_are_marked(self):
        rows = matrix("rock_pile", [0, 50])
        rows[0].update(t_s_waiting_ms=1.5)  # mindp none: 1.51 of 20 ms
        rows[1].update(t_s_waiting_ms="nan")  # mindp kl, where the other step knows 0.01 of 11 ms
        rows[2].update(t_s_waiting_ms=1.1)  # mindp fm: 1.11 of 24 ms are still few
        write_steps(self.directory, rows)
        text = self.table()
        self.assertEqual([line.split("|")[0].split() for line in text.splitlines() if line.endswith("|‡")],
                         [["mindp", "none"]])
        self.assertIn("‡ The solves waited more than 5 % of t_s for a core", text)
        self.assertIn("Rock Pile mindp none 8 %", " ".join(text.split()))
        self.assertIn("10.00 + 0.125‡", self.table("--format", "markdown"))
        self.assertEqual(self.table("--format", "latex").count("$^\\ddagger$"), 2)  # the cell and the caption
        self.assertEqual(self.cells()["rock_pile", "mindp", "none"]["waiting_share"], "0.0755")

    def test_a_scene_whose_threads_were_far_apart_for_long_is_told(self):
        for rows, told in ((2, ""), (3, "Rock Pile: for 6 % of t_s the threads were on cores far apart")):
            write_steps(self.directory, [row | {"core_round_trip_ns": 300 if place < rows else 299.9 if place % 2 else "nan"}
                                         for place, row in enumerate(matrix("rock_pile", [0, 50]))])
            text = " ".join(self.table().split())
            self.assertIn(told, text)
            self.assertEqual("far apart" in text, bool(told))


class MessageTest(Table1Test):

    def test_bad_input_is_one_line(self):
        path = write_steps(self.directory, matrix("rock_pile", [0]))
        whole = path.read_text()
        for text, words in (("", "empty file"), (whole.replace("t_pr_ms",
                                                               "t_xx_ms"), "missing column t_pr_ms"),
                            (whole.splitlines()[0] + "\n",
                             "no measured rows"), (whole.replace(",0.125,",
                                                                 ",nan,"), "status ok, but t_pr_ms is 'nan'"),
                            (whole.replace(",0.125,", ",fast,"), "column t_pr_ms is 'fast'")):
            with self.subTest(words=words):
                path.write_text(text)
                error = self.table(code=1)
                self.assertIn(words, error)
                self.assertEqual(len(error.splitlines()), 1)

    def test_an_unfinished_last_line_is_reported(self):
        path = write_steps(self.directory, matrix("rock_pile", [0, 50]))
        path.write_text(path.read_text()[:-5])
        self.assertIn("steps.csv: the last line was not finished", self.table())
        self.assertEqual(self.cells()["rock_pile", "mix", "fm"]["steps_ok"], "1")

    def test_an_interrupted_run_is_reported(self):
        write_steps(self.directory, matrix("rock_pile", [0]))
        for state, words in (("interrupted", "the state of the run is interrupted"), ("complete", "")):
            write_manifest(self.directory, state=state)
            self.assertIn(words, self.table())
        self.assertNotIn("state of the run", self.table())

    def test_wrong_options_exit_with_one(self):
        for arguments in (["--format", "xml"], ["--where", "threads"], ["--unknown"]):
            self.assertIn("table1: ", self.table(*arguments, code=1))


class FormatTest(Table1Test):

    def setUp(self):
        super().setUp()
        write_matrix(self.directory)

    def test_text_names_both_machines_marks_the_lowest_and_fits(self):
        for scene in SCENES:
            write_manifest(self.directory / scene, **MANIFEST)
        text = self.table()
        self.assertIn("8 cores at 2.4 GHz", text)
        self.assertIn(MACHINE, text)
        self.assertEqual(text.count("Ours: "), 1)
        self.assertLessEqual(max(map(len, text.splitlines())), 110)
        block = text[text.index("Rock Pile: 10 measured steps, solver schur, 2 threads"):].splitlines()[3:18]
        self.assertEqual([tuple(line[:14].split()) for line in block], list(COMBINATIONS))
        self.assertEqual([index for index, line in enumerate(block) if "*" in line], [0, 14])
        self.assertRegex(
            block[0], r"10\.000 +0\.125 +10\.125\* \| +144\.5 +1\.2 +145\.7  \| +0\.0692 +0\.104 +0\.0695")
        self.assertEqual(len({len(line) for line in block}), 1)

    def test_without_manifest_the_machine_is_unknown(self):
        self.assertIn("unknown", self.table())

    def test_scenes_without_rows_are_named(self):
        result = run_script("table1", self.directory / "rock_pile")
        self.assertIn("No rows of chain_drop, log_tower, large_rock_pile", result.stdout)

    def test_markdown_has_a_row_a_combination_and_bold_marks(self):
        text = self.table("--format", "markdown")
        rows = [line for line in text.splitlines() if line.startswith("|")]
        self.assertEqual({line.count("|") for line in rows}, {6})
        self.assertEqual(len(rows), 17)
        self.assertEqual(text.count("**"), 2 * 8)  # in every scene our lowest and the paper's
        self.assertIn("| mindp none | **10.00 + 0.125**", text)

    def test_latex_is_balanced(self):
        text = self.table("--format", "latex")
        columns = 1 + 3 * 4
        self.assertIn("{l" + "rrr" * 4 + "}", text)
        body = text[text.index("\\midrule"):text.index("\\bottomrule")].splitlines()[1:]
        self.assertEqual(len(body), len(COMBINATIONS))
        self.assertEqual({line.count("&") for line in body}, {columns - 1})
        self.assertTrue(all(line.endswith("\\\\") for line in body))
        self.assertEqual(text.count("{"), text.count("}"))
        self.assertEqual(re.findall(r"(?<!\\)[_#%](?!pr|s\$|\{)", "\n".join(text.splitlines()[1:])), [])
        for mark in ("\\toprule", "\\begin{tabular}", "\\end{tabular}", "\\textbf{10.00 + 0.125}"):
            self.assertIn(mark, text)

    def test_csv_reads_back(self):
        self.assertEqual(
            len(
                list(
                    csv.DictReader(
                        io.StringIO("".join(line for line in self.table("--format", "csv").splitlines(True)
                                            if line[0] != "#"))))), len(SCENES) * len(COMBINATIONS))


if __name__ == "__main__":
    unittest.main()
