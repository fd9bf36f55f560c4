"""Reading of steps.csv and manifest.json: what is tolerated and what is an error that names the file."""
import pathlib
import tempfile
import unittest

from synthetic import matrix, write_manifest, write_steps

from cleave_scripts.results.errors import ResultError
from cleave_scripts.results.manifest import load_manifest
from cleave_scripts.results.paper import PARTITIONERS, REFINERS, SCENES, load_paper_table1
from cleave_scripts.results.steps import find_steps_files, load_steps


class LoadStepsTest(unittest.TestCase):

    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)
        self.directory = pathlib.Path(self.scratch.name)
        self.path = self.directory / "steps.csv"

    def write(self, text):
        self.path.write_bytes(text.encode())

    def assert_error(self, *words, required=()):
        with self.assertRaises(ResultError) as caught:
            load_steps(self.path, required)
        self.assertEqual(len(str(caught.exception).splitlines()), 1)
        for word in (str(self.path), *words):
            self.assertIn(word, str(caught.exception))

    def test_reads_every_row_with_its_line(self):
        write_steps(self.directory, matrix("rock_pile", [0, 50]))
        rows, notes = load_steps(self.path, ["t_s_ms"])
        self.assertEqual((len(rows), notes), (30, []))
        self.assertEqual((rows[0].line, rows[-1].line, rows[-1].number("t_s_ms")), (2, 31, 24))

    def test_quoted_commas_and_windows_line_ends(self):
        self.write('a,b\r\n"x, y",2\r\n')
        rows, _ = load_steps(self.path)
        self.assertEqual((rows[0]["a"], rows[0].integer("b")), ("x, y", 2))

    def test_last_line_without_end_is_left_out_and_noted_even_when_it_looks_whole(self):
        for rest in ("3", "3,4.12"):
            with self.subTest(rest=rest):
                self.write("a,b\n1,2\n" + rest)
                rows, notes = load_steps(self.path)
                self.assertEqual([row["a"] for row in rows], ["1"])
                self.assertEqual(len(notes), 1)
                self.assertIn("not finished", notes[0])

    def test_a_short_line_in_the_middle_is_an_error(self):
        self.write("a,b\n1\n3,4\n")
        self.assert_error("line 2", "1 values", "header has 2")

    def test_missing_columns_are_named(self):
        self.write("a,b\n1,2\n")
        self.assert_error("missing column t_s_ms, t_pr_ms", required=["a", "t_s_ms", "t_pr_ms"])

    def test_a_column_that_stands_twice(self):
        self.write("a,b,a\n1,2,3\n")
        self.assert_error("column a", "twice")

    def test_empty_file(self):
        self.write("")
        self.assert_error("empty file")

    def test_header_without_end(self):
        self.write("a,b")
        self.assert_error("header")

    def test_header_alone_is_noted(self):
        self.write("a,b\n")
        rows, notes = load_steps(self.path)
        self.assertEqual((rows, len(notes)), ([], 1))

    def test_no_text(self):
        self.path.write_bytes(b"\xff\xfe\x00,\n")
        self.assert_error("not a text file")

    def test_no_file(self):
        self.assert_error("No such file")

    def test_a_value_that_is_no_number_names_line_and_column(self):
        self.write("a,b\n1,x\n")
        rows, _ = load_steps(self.path)
        for read in (rows[0].number, rows[0].integer):
            with self.assertRaisesRegex(ResultError, "line 2: column b is 'x'"):
                read("b")


class FindTest(unittest.TestCase):

    def test_file_directory_and_directory_of_directories(self):
        with tempfile.TemporaryDirectory() as scratch:
            root = pathlib.Path(scratch)
            paths = [write_steps(root / name, matrix("rock_pile", [0])) for name in ("a", "b")]
            self.assertEqual(find_steps_files([root]), paths)
            self.assertEqual(find_steps_files([root / "b", paths[0], root]), [paths[1], paths[0]])
            (root / "none").mkdir()
            for wrong in ("none", "absent"):
                with self.assertRaisesRegex(ResultError, wrong):
                    find_steps_files([root / wrong])


class ManifestTest(unittest.TestCase):

    def test_absent_present_and_damaged(self):
        with tempfile.TemporaryDirectory() as scratch:
            self.assertEqual(load_manifest(scratch), {})
            write_manifest(scratch, seed=7)
            self.assertEqual(load_manifest(scratch), {"seed": 7})
            for damaged in ("{", "[]"):
                (pathlib.Path(scratch) / "manifest.json").write_text(damaged)
                with self.assertRaisesRegex(ResultError, "manifest.json"):
                    load_manifest(scratch)


class PaperTest(unittest.TestCase):

    def setUp(self):
        self.paper = load_paper_table1()

    def test_every_cell_is_there(self):
        self.assertEqual(
            set(self.paper), {(scene, partitioner, refiner) for scene in SCENES
                              for partitioner in PARTITIONERS for refiner in REFINERS})
        self.assertEqual(len(self.paper), 60)

    def test_lowest_totals_and_slowest_solves_are_the_papers(self):
        lowest = {
            "chain_drop": ("bfs", "fm", 3.6),
            "log_tower": ("mix", "fm", 27.1),
            "rock_pile": ("mix", "fm", 79.6),
            "large_rock_pile": ("mix", "fm", 576.1)
        }
        slowest = {"chain_drop": 6.3, "log_tower": 103.4, "rock_pile": 697.1, "large_rock_pile": 6127.1}
        for scene in SCENES:
            cells = {key[1:]: times for key, times in self.paper.items() if key[0] == scene}
            best = min(cells, key=lambda names: sum(cells[names]))
            self.assertEqual((*best, round(sum(cells[best]), 1)), lowest[scene])
            self.assertEqual(max(t_s for t_s, _ in cells.values()), slowest[scene])

    def test_sums_of_each_scene(self):
        # Against slips of a digit: the sums over the 15 cells of a scene.
        sums = {
            scene: [
                round(sum(times[which]
                          for key, times in self.paper.items()
                          if key[0] == scene), 1)
                for which in (0, 1)
            ] for scene in SCENES
        }
        self.assertEqual(
            sums, {
                "chain_drop": [68.7, 14.6],
                "log_tower": [561.4, 116.6],
                "rock_pile": [3888.1, 32.0],
                "large_rock_pile": [22725.8, 79.0]
            })


if __name__ == "__main__":
    unittest.main()
