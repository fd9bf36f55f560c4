"""scripts/report on a tiny tree: what it writes, what it makes of missing and damaged data."""
import base64
import pathlib
import re
import shutil
import tempfile
import unittest

import matplotlib.image
from report_data import OF_TRADEOFF, PAPER, manifest, report_row, rows_of, whole_system, write_run, write_tree
from synthetic import run_script, write_manifest, write_steps

from cleave_scripts.figures import data, kernel_value, looks, solver_groups, style, times_by_step, trade_off, tree
from cleave_scripts.figures.choose import merged_runs
from cleave_scripts.figures.registry import FIGURES
from cleave_scripts.figures.tables import scene_tables
from cleave_scripts.figures.tree import NoData
from cleave_scripts.figures.verdicts import judge_all
from cleave_scripts.results.names import NO_PARTITIONER
from cleave_scripts.results.paper import COMBINATIONS, PARTITIONERS


class TreeTest(unittest.TestCase):

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.directory = pathlib.Path(scratch.name)

    def report(self, *arguments, code=0):
        """(page, what was said on stderr)"""
        result = run_script("report", self.directory, *arguments)
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertNotIn("Traceback", result.stderr)
        self.assertNotIn("Warning", result.stderr)
        page = self.directory / "report.html"
        return page.read_text(encoding="utf-8") if page.exists() else "", result.stderr

    def assert_has(self, page, *texts):
        """As assertIn, without printing the page."""
        for text in texts:
            self.assertTrue(text in page, f"not in the page: {text[:200]}")

    def drawn(self):
        """{name of figure: caption, or the NoData} without going through files."""
        loaded, results = data.load(self.directory, "schur"), {}
        for figure in FIGURES:
            try:
                picture, results[figure.name] = figure.draw(loaded)
                style.pyplot.close(picture)
            except NoData as gap:
                results[figure.name] = gap
        return results


class WholeTreeTest(TreeTest):

    def test_everything_is_drawn_and_the_page_needs_nothing_else(self):
        write_tree(self.directory)
        page, said = self.report()
        for figure in FIGURES:
            for ending in ("pdf", "png"):
                path = self.directory / "figures" / f"{figure.name}.{ending}"
                self.assertGreater(path.stat().st_size, 5000, path)
            picture = matplotlib.image.imread(path)
            self.assertGreater(picture.std(), 0.03, path)
            self.assert_has(page, base64.b64encode(path.read_bytes()).decode())
        targets = re.findall(r'(?:src|href)="([^"]*)"', page) + re.findall(r"url\(([^)]*)\)", page)
        self.assertGreater(len(targets), 20)
        self.assertEqual([target for target in targets if not target.startswith(("data:", "#"))], [])
        self.assertEqual(page.count('class="missing"'), 3)  # Figures 1 and 2 and the replay
        self.assertEqual(said.count("no data"), 3)
        self.assertIn("no motion recorded", said)

    def test_every_caption_names_steps_and_machine(self):
        write_tree(self.directory)
        for name, caption in self.drawn().items():
            self.assertIsInstance(caption, str, name)
            if name not in ("ladder", "verdict_map", *OF_TRADEOFF):
                self.assertRegex(caption, r"Some_CPU, 6 cores, 1 thread", name)
            if name not in ("ladder", "speed_up", "verdict_map", *OF_TRADEOFF):
                self.assertRegex(caption, r"Measured steps: .* 9[.,]", name)

    def test_the_same_data_give_the_same_files(self):
        write_run(self.directory / "log_tower", rows_of("log_tower"))
        contents = []
        for name in ("a", "b"):
            picture, _ = FIGURES[0].draw(data.load(self.directory, "schur"))
            contents.append([path.read_bytes() for path in style.save(picture, self.directory / name, "x")])
        self.assertEqual(contents[0], contents[1])

    def test_table_1_is_there_in_every_format(self):
        for scene in ("rock_pile", "log_tower"):
            write_run(self.directory / scene, rows_of(scene))
        page, _ = self.report()
        table = page[page.index('<table class="numbers">'):]
        self.assertEqual(table[:table.index("</table>")].count('class="chip"'), len(COMBINATIONS))
        self.assertIn("\\toprule", (self.directory / "figures" / "table1.tex").read_text())
        self.assertIn("mix,fm", (self.directory / "figures" / "table1.csv").read_text())
        self.assertIn("| mix fm |", (self.directory / "figures" / "table1.md").read_text())

    def test_table_1_has_the_medians_of_repeated_runs_as_the_figures_have(self):
        for name, share, status in (("a", 1, "ok"), ("b", 9, "ok"), ("c", 2, "ok"), ("d", 100, "not_converged")):
            rows = rows_of("rock_pile", steps=(9, 19), status=status)
            for row in rows:
                row.update(t_s_ms=share * row["t_s_ms"], t_pr_ms=share)
            write_run(self.directory / name, rows)
        loaded = data.load(self.directory, "schur")
        table, = scene_tables(loaded)[0]
        cell, = (cell for cell in table.cells if (cell.partitioner, cell.refiner) == ("mix", "fm"))
        alone = [report_row("rock_pile", step, "mix", "fm")["t_s_ms"] for step in (9, 19)]
        self.assertAlmostEqual(cell.ours.t_s_ms, 2 * sum(alone) / 2, 9)
        self.assertEqual((cell.ours.t_pr_ms, cell.ok, cell.failed), (2, 2, 0))
        drawn = merged_runs(loaded.main["rock_pile"])
        drawn = drawn[(drawn["partitioner"] == "mix") & (drawn["refiner"] == "fm")]
        self.assertEqual((len(drawn), drawn["t_s_ms"].mean()), (2, cell.ours.t_s_ms))

    def test_rendered_figures_and_film_strips_are_embedded(self):
        write_run(self.directory / "rock_pile", rows_of("rock_pile"))
        self.report()
        source = self.directory / "figures" / "figure3.png"
        for name in ("figure1", "figure2", "film_strip"):
            shutil.copy(source, source.with_name(f"{name}.png"))
        source.with_name("figure1.txt").write_text("Told by the renderer & its file.\n")
        page, said = self.report()
        self.assertEqual(page.count(base64.b64encode(source.read_bytes()).decode()), 4)
        self.assert_has(page, "Told by the renderer &amp; its file.")
        self.assertNotIn("no motion recorded", said)


class NewcomersTest(TreeTest):

    def test_new_partitioners_refiners_solvers_and_stages_appear_by_themselves(self):
        rows = rows_of("rock_pile", ("mindp", "mix", "metis"), ("none", "fm", "tabu"))
        for row in rows:
            row["t_s_wait_ms"] = 1.0
        write_run(self.directory / "a", rows)
        write_run(self.directory / "b", whole_system("quantum", t_s_ms=1))
        loaded = data.load(self.directory, "schur")
        parts, = solver_groups.groups(loaded.blocks).values()
        self.assertEqual(set(trade_off.points(parts)["label"]), {"schur", "quantum"})
        for name in ("figure3", "trade_off", "stages", "interface_cost", "speed_up"):
            self.assertIsInstance(self.drawn()[name], str, name)
        page, _ = self.report()
        self.assert_has(page, "metis tabu")
        figure = next(entry for entry in FIGURES if entry.name == "stages").draw(loaded)[0]
        self.assertIn("wait", [text.get_text() for text in figure.legends[0].get_texts()])

    def test_one_colour_a_partitioner_and_one_look_a_refiner(self):
        names = [*PARTITIONERS, NO_PARTITIONER, "metis"]
        colors = [looks.color(name) for name in names]
        self.assertEqual(len(set(colors)), len(names))
        self.assertEqual(looks.color("metis"), looks.color("metis"))
        hatches = [looks.bar_look("mix", name)["hatch"] for name in ("none", "kl", "fm", "tabu")]
        markers = [looks.line_look("mix", name)["marker"] for name in ("none", "kl", "fm", "tabu")]
        self.assertEqual((len(set(hatches)), len(set(markers))), (4, 4))

    def test_solvers_that_differ_in_an_option_are_told_apart(self):
        for sweeps in (5, 50):
            write_run(self.directory / str(sweeps), whole_system("pgs"), sweeps=sweeps)
        parts, = solver_groups.groups(data.load(self.directory, "schur").blocks).values()
        self.assertEqual(set(trade_off.points(parts)["label"]), {"pgs", "pgs, 50 sweeps"})

    def test_an_option_of_one_solver_does_not_rename_the_others(self):
        rows = [row for name in ("ode-quickstep", "ode-step", "monolithic") for row in whole_system(name)]
        write_run(self.directory / "a", rows, **{"quickstep-iterations": 200, "ode-step-max-rows": 500})
        write_run(self.directory / "b",
                  rows_of("rock_pile", solver="pivot:schur-bodies"),
                  kernel="schur-bodies")
        parts, = solver_groups.groups(data.load(self.directory, "schur").blocks).values()
        self.assertEqual(set(trade_off.points(parts)["label"]),
                         {"ode-quickstep, 200 iterations", "ode-step", "monolithic", "pivot:schur-bodies"})

    def test_a_solver_that_splits_nothing_stands_beside_those_on_parts_and_motion_beside_none(self):
        for name, rows, parts_of in (("parts", rows_of("rock_pile"), ("25", "bodies")),
                                     ("whole", whole_system("pgs"), ("-", "-")),
                                     ("motion", rows_of("rock_pile"), ("25", "bodies"))):
            write_run(self.directory / name, [row | dict(zip(("max_bodies", "degree"), parts_of)) for row in rows],
                      **{"record-motion": name == "motion"})
        parts, = solver_groups.groups(data.load(self.directory, "schur").blocks).values()
        self.assertEqual([part.experiment.name for part in parts], ["parts", "whole"])

    def test_figures_are_of_the_run_that_was_solved_most_often_and_peaks_of_the_longest(self):
        write_run(self.directory / "motion", rows_of("log_tower", steps=range(90), repeat_count=1))
        write_run(self.directory / "paper", rows_of("log_tower"))
        write_run(self.directory / "paper_1", rows_of("log_tower"), threads=1)
        long = rows_of("log_tower", ("mindp",), steps=range(90), threads=2)
        long[0]["step"] = 95
        write_run(self.directory / "every_step",
                  [*long, *rows_of("log_tower", ("mindp",), steps=(96,), threads=2)])
        loaded = data.load(self.directory, "schur")
        self.assertEqual(loaded.main["log_tower"][0].experiment.name, "paper")
        runs = times_by_step.longest_runs(loaded)
        self.assertEqual([part.experiment.name for part in runs], ["every_step"])
        self.assertIn("Measured steps: Log Tower 92.", self.drawn()["figure5"])

    def test_a_bar_far_above_the_others_is_cut_and_carries_its_value(self):
        rows = rows_of("log_tower")
        for row in rows:
            row["t_s_ms"] = 1234 if (row["partitioner"], row["refiner"]) == ("maxdp", "kl") else 10
        write_run(self.directory / "log_tower", rows)
        loaded = data.load(self.directory, "schur")
        for name, text in (("figure3", "1234"), ("stages", "1234 ms")):
            figure = next(entry for entry in FIGURES if entry.name == name).draw(loaded)[0]
            texts = [label.get_text() for label in figure.axes[0].texts]
            self.assertIn(text, texts, name)
            self.assertLess(
                max(figure.axes[0].get_ylim()[1 if name == "figure3" else 0], figure.axes[0].get_xlim()[1]),
                40)
            style.pyplot.close(figure)

    def test_kernels_are_compared_on_the_steps_that_both_solved(self):
        some = {"partitioners": ("mindp", "mix"), "refiners": ("none", "fm")}
        rows = rows_of("rock_pile", *some.values())
        for row in rows:
            row["t_s_ms"] = 20 if row["partitioner"] == "mindp" and row["step"] < 50 else 10
        write_run(self.directory / "a", rows)
        write_run(self.directory / "b", [
            dict(row, solver="pivot:schur-bodies", kernel="schur-bodies", t_s_ms=5)
            for row in rows
            if row["step"] < 50
        ],
                  kernel="schur-bodies")
        parts, = solver_groups.groups(data.load(self.directory, "schur").blocks).values()
        found = kernel_value.ratios(parts)["pivot"]
        self.assertEqual({kernel: (ratio, steps) for kernel, (ratio, _, _, steps) in found.items()},
                         {"schur-rows": (2, 5), "schur-bodies": (1, 5)})

    def test_runs_of_different_setups_are_not_mixed(self):
        write_run(self.directory / "a", rows_of("rock_pile"))
        write_run(self.directory / "b", rows_of("rock_pile", ("mix",), t_s_ms=1e6), cfm=1e-3)
        write_run(self.directory / "c", rows_of("rock_pile", ("mix",), t_s_ms=1e6))
        write_run(self.directory / "d", rows_of("rock_pile", t_s_ms=1e6), **{"predictor-sweeps": 500})
        loaded = data.load(self.directory, "schur")
        self.assertEqual([part.experiment.name for part in loaded.main["rock_pile"]], ["a"])
        self.assertIn("of another setup or with fewer combinations: b, c, d", " ".join(loaded.messages))


    def test_runs_of_two_processors_are_not_mixed(self):
        for name, model in (("a", "Some_CPU"), ("b", "Another")):
            write_steps(self.directory / name, rows_of("rock_pile", seed=name))
            write_manifest(self.directory / name, **manifest("rock_pile") | {"machine": {"cpu_model": model, "cores": 2}})
        loaded = data.load(self.directory, "schur")
        self.assertEqual([part.experiment.name for part in loaded.main["rock_pile"]], ["a"])


class DamageTest(TreeTest):

    def write_small(self, change):
        rows = rows_of("log_tower", ("mindp", "mix"), ("none", "fm"), (9, 19))
        rows += rows_of("log_tower", ("-",), ("-",), (9, 19), solver="exact", kernel="auto")
        for row in rows:
            change(row)
        write_steps(self.directory / "a", rows)
        write_manifest(self.directory / "a", **manifest("log_tower"))

    def assert_made(self):
        """Everything is drawn, judged or a gap; what is neither raises."""
        self.drawn()
        loaded = data.load(self.directory, "schur")
        judge_all(loaded, PAPER)
        return loaded

    def test_without_any_one_column_there_is_a_report(self):
        for missing in report_row("rock_pile", 9, "mix", "fm"):
            with self.subTest(missing=missing):
                self.write_small(lambda row, name=missing: row.pop(name))
                tables, faults = scene_tables(self.assert_made())
                self.assertEqual(len(tables) + len(faults), 0 if missing in tree.REQUIRED else 1)

    def test_a_column_of_nonsense_is_as_good_as_none(self):
        for name in ("t_s_ms", "interface_rows", "factor_mflop_local", "t_s_model_p1_ms", "threads", "step"):
            for value in ("garbage", "inf", "0"):
                with self.subTest(name=name, value=value):
                    self.write_small(lambda row, name=name, value=value: row.update({name: value}))
                    self.assert_made()

    def test_a_manifest_of_nonsense_is_as_good_as_none(self):
        self.write_small(lambda row: None)
        for entry in ("options", "build", "machine", "state"):
            for value in (None, [], "x", {"git_hash": 3, "skip": [], "threads": None}):
                with self.subTest(entry=entry, value=value):
                    write_manifest(self.directory / "a", **dict(manifest("log_tower"), **{entry: value}))
                    loaded = data.load(self.directory, "schur")
                    self.assertIn("log_tower", loaded.main)
                    self.assertIn("Machine", FIGURES[0].draw(loaded)[1])

    def test_a_missing_column_is_named_in_the_gap(self):
        rows = rows_of("rock_pile")
        for row in rows:
            del row["interface_rows"]
        write_run(self.directory / "rock_pile", rows)
        write_run(self.directory / "log_tower", rows_of("log_tower"))
        caption = self.drawn()["interface_cost"]
        self.assertIn("No data: Rock Pile, column interface_rows is missing.", caption)
        shutil.rmtree(self.directory / "log_tower")
        page, said = self.report()
        self.assertIn("The price of interface rows: no data: Rock Pile, column interface_rows is missing",
                      said)
        self.assert_has(page, '<div class="missing">no data: Rock Pile, column interface_rows')
        self.assertFalse((self.directory / "figures" / "interface_cost.png").exists())

    def test_damaged_files_become_messages(self):
        write_run(self.directory / "good", rows_of("rock_pile"))
        texts = {
            "empty": "",
            "header": "scene,step\n",
            "words": "no table\n",
            "binary": "\x00\xff\x00",
            "no_rows": (self.directory / "good" / "steps.csv").read_text().splitlines()[0] + "\n"
        }
        for name, text in texts.items():
            (self.directory / name).mkdir()
            (self.directory / name / "steps.csv").write_bytes(text.encode("latin-1"))
        half = write_steps(self.directory / "half", rows_of("log_tower"))
        half.write_text(half.read_text()[:-20])
        write_manifest(self.directory / "half", **dict(manifest("log_tower"), state="running"))
        write_steps(self.directory / "bad_manifest", rows_of("chain_drop", steps=(9,)))
        (self.directory / "bad_manifest" / "manifest.json").write_text("{")
        (self.directory / "ladder.csv").write_text("rung,value\n1,2\n")
        (self.directory / "tradeoff.csv").write_text("series,scene\npaper,rock_pile\n")
        (self.directory / "tradeoff_motion.csv").write_text("scene\nrock_pile\n")
        page, said = self.report()
        for words in ("empty/steps.csv: empty file", "header/steps.csv: missing column partitioner",
                      "words/steps.csv: missing column scene", "binary/steps.csv: not a text file",
                      "no_rows/steps.csv: no rows", "half/steps.csv: the last line was not finished",
                      "the state of the run is running", "bad_manifest/manifest.json",
                      "ladder.csv: missing column parameter", "tradeoff.csv: missing column bodies",
                      "tradeoff_motion.csv: missing column mover"):
            self.assertIn(words, said)
            self.assert_has(page, words)
        self.assertTrue((self.directory / "figures" / "figure3.png").exists())

    def test_a_table_of_accuracy_that_was_cut_short_keeps_what_is_whole(self):
        write_tree(self.directory)
        path = self.directory / "tradeoff.csv"
        path.write_text("\n".join(path.read_text().splitlines()[:-3]) + "\n")  # the last step with two of five limits
        loaded = data.load(self.directory, "schur")
        self.assertIn(f"{path}: 3 of 27 rows are of steps that do not have every solve and are left out", loaded.messages)
        self.assertEqual(len(loaded.tree.accuracy), 4)
        for name in OF_TRADEOFF:
            self.assertIsInstance(self.drawn()[name], str)
        path.write_text("\n".join(line for line in path.read_text().splitlines() if ",exact," not in line) + "\n")
        loaded = data.load(self.directory, "schur")
        self.assertIsNone(loaded.tree.accuracy)
        self.assertIn(f"{path}: no solver exact; the file is left out", loaded.messages)

    def test_a_failed_cell_leaves_a_marked_gap(self):
        rows = rows_of("log_tower")
        for row in rows:
            if (row["partitioner"], row["refiner"]) == ("mindp", "kl"):
                row.update(status="diverged", t_s_ms="nan")
            if (row["partitioner"], row["refiner"], row["step"]) == ("mindp", "fm", 19):
                row.update(status="not_converged")
        write_run(self.directory / "log_tower", rows)
        loaded = data.load(self.directory, "schur")
        figure = FIGURES[0].draw(loaded)[0]
        self.assertIn("no step ok", [text.get_text() for text in figure.axes[0].texts])
        self.assertIn("Crosses: steps without a row that is ok", self.drawn()["figure5"])
        page, said = self.report()
        self.assertIn(
            "10 rows of 135 not ok: 9 diverged by schur mindp kl, 1 not_converged by schur mindp fm", said)
        self.assert_has(page, "Log Tower, mindp kl: 9 of 9 steps failed.")
        self.assert_has(page, '<span class="gap">no data</span>')

    def test_a_value_that_is_no_number_is_named_and_left_out(self):
        rows = rows_of("rock_pile")
        rows[3]["t_s_ms"] = "fast"
        write_run(self.directory / "rock_pile", rows)
        page, said = self.report()
        self.assertIn("line 5: column t_s_ms is 'fast', expected a number; 1 such values are left out", said)
        self.assert_has(page, "no data: Rock Pile, ")  # Table 1 averages no scene with such a value
        self.assertTrue((self.directory / "figures" / "figure3.png").exists())

    def test_words_of_a_parameter_that_some_rows_do_not_have_are_no_damage(self):
        rows = rows_of("rock_pile")
        for row in rows:
            row["degree"] = "bodies" if row["partitioner"] == "mix" else "-"
        rows[0]["max_bodies"] = "many"  # among numbers it is
        write_run(self.directory / "rock_pile", rows)
        loaded = data.load(self.directory, "schur")
        self.assertEqual(set(loaded.tree.experiments[0].rows["degree"]), {"bodies", "-"})
        self.assertEqual([text for text in loaded.messages if "expected a number" in text],
                         [text for text in loaded.messages if "column max_bodies is 'many'" in text])
        self.assertIn("max_bodies", " ".join(loaded.messages))

    def test_steps_before_skip_are_left_out(self):
        write_run(self.directory / "rock_pile", rows_of("rock_pile"), skip=20)
        loaded = data.load(self.directory, "schur")
        self.assertEqual(sorted(set(loaded.tree.experiments[0].rows["step"])), list(range(29, 90, 10)))
        self.assertIn("30 rows before --skip are left out", loaded.messages[0])

    def test_without_the_solver_everything_is_a_gap_and_one_that_is_asked_for_has_to_be_there(self):
        write_run(self.directory / "rock_pile", rows_of("rock_pile", solver="dense"))
        _, said = self.report()
        self.assertIn("Figure 3: no data: no rows of the chosen solver in any scene", said)
        self.assertIn("Table 1: no data: no rows of solver schur", said)
        _, said = self.report("--solver", "dence", code=1)
        self.assertEqual(said, "report: --solver has 'dence', expected some of dense; did you mean dense?\n")

    def test_bad_input_is_one_line(self):
        for directory, words in (("nowhere", "no such directory"), (".", "neither steps.csv nor ladder.csv")):
            result = run_script("report", self.directory / directory)
            self.assertEqual((result.returncode, len(result.stderr.splitlines())), (1, 1), result.stderr)
            self.assertIn(words, result.stderr)
        self.assertEqual(list(self.directory.iterdir()), [])


if __name__ == "__main__":
    unittest.main()
