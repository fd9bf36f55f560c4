"""What the figures of scripts/report look like, as far as it can be told without pixels."""
import itertools
import json
import pathlib
import tempfile
import unittest

import numpy
import pandas
from matplotlib.colors import to_rgb
from report_data import report_row, rows_of, whole_system, write_run, write_tree

from cleave_scripts.figures import data, interface_cost, looks, style
from cleave_scripts.figures.registry import FIGURES
from cleave_scripts.figures.runs import runs_body
from cleave_scripts.motion.colour_vision import contrast
from cleave_scripts.results.names import title
from cleave_scripts.results.paper import PARTITIONERS, SCENES

def difference(first, second):
    """The least of the differences that usual and red-green blind eyes see; 2.3 is just noticeable."""
    return contrast([to_rgb(first)], [to_rgb(second)])[0, 0]


def closest(colors):
    """(difference, name, name) of the two of {name: colour} that look most alike."""
    return min((difference(colors[one], colors[other]), one, other) for one, other in itertools.combinations(colors, 2))


SWEEPS = (10, 30, 100, 300, 1000, 3000)


class FigureCase(unittest.TestCase):

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.directory = pathlib.Path(scratch.name)
        self.addCleanup(style.pyplot.close, "all")

    def draw(self, name):
        loaded = data.load(self.directory, "schur")
        figure, self.caption = next(entry for entry in FIGURES if entry.name == name).draw(loaded)
        figure.draw_without_rendering()
        return figure


class ColourTest(unittest.TestCase):

    def setUp(self):
        looks.meet([])
        self.addCleanup(looks.meet, [])

    def test_red_green_blind_eyes_tell_the_colours_of_each_kind_apart(self):
        cycle = {color: color for color in (*looks.CYCLE, looks.WHOLE_SYSTEM)}
        self.assertGreaterEqual(len(cycle), 13)
        for colors, limit in ((cycle, 20), (looks.STAGES, 10)):
            least, *names = closest(colors)
            self.assertGreater(least, limit, names)

    def test_the_measure_finds_what_they_confuse(self):
        self.assertLess(difference("#882255", "#7A3A60"), 20)
        self.assertLess(difference("#CC6677", "#44AA99"), 20)  # far apart for others
        self.assertGreater(difference("#000000", "#FFFFFF"), 99)

    def test_the_papers_partitioners_have_the_first_colours_whoever_else_is_there(self):
        frame = pandas.DataFrame({"partitioner": ["later", *PARTITIONERS[::-1]], "refiner": "none", "solver": "schur"})
        looks.meet([frame])
        self.assertEqual([looks.color(name) for name in (*PARTITIONERS, "later")], list(looks.CYCLE[:len(PARTITIONERS) + 1]))
        self.assertEqual(looks.partitioners_in(["-", "later", PARTITIONERS[0]]), [PARTITIONERS[0], "later", "-"])

    def test_a_solver_has_one_look_whatever_its_parameters_and_more_names_than_colours_have_marks(self):
        names = [f"solver_{number}" for number in range(20)]
        looks.meet([pandas.DataFrame({"partitioner": "-", "refiner": "-", "solver": names})])
        marks = [looks.solver_look(name) for name in names]
        self.assertEqual(len({(mark["color"], mark["marker"]) for mark in marks}), len(names))
        self.assertEqual(looks.solver_look("solver_3@sweeps=30"), marks[3])


class TradeOffTest(unittest.TestCase):
    """Two panels in which the solvers stand in another order, with crowded and with far points."""

    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as directory:
            for bodies, slow in ((50, 1), (200, 7)):
                cls.write(pathlib.Path(directory) / f"rocks_{bodies}", bodies, slow)
            cls.loaded = data.load(directory, "schur")
        cls.figure = cls.draw()
        cls.addClassCleanup(style.pyplot.close, "all")
        cls.scatters = cls.figure.axes[::2]

    @classmethod
    def draw(cls):
        figure, _ = next(entry for entry in FIGURES if entry.name == "trade_off").draw(cls.loaded)
        figure.draw_without_rendering()
        return figure

    @staticmethod
    def write(folder, bodies, slow):
        direct = rows_of("rock_pile", ("mindp", "mix"), ("none", "fm"), bodies=bodies, t_s_ms=slow)
        for solver in ("monolithic", "exact"):
            direct += whole_system(solver, bodies=bodies, t_s_ms=0.97 * slow)
        if bodies == 50:
            direct += whole_system("ode-step", bodies=bodies, t_s_ms=50, residual_m_per_s=1e-14)
        write_run(folder / "direct", direct, bodies=bodies)
        families = (("pgs", "sweeps", slow**0.5 / 12, -1.5),
                    ("ode-quickstep", "quickstep-iterations", 0.1, -1.6))
        for index, count in enumerate(SWEEPS):
            for solver, option, time_ms, slope in families:
                rows = whole_system(solver,
                                    bodies=bodies,
                                    t_s_ms=count * time_ms,
                                    residual_m_per_s=10.0**(-1 + slope * index),
                                    status="not_converged")
                write_run(folder / f"{solver}_{count}", rows, bodies=bodies, **{option: count})

    def boxes(self, ax):
        return {text: text.get_window_extent() for text in ax.texts}

    def test_a_solver_has_one_colour_and_marker_in_all_panels_and_the_legend(self):
        self.assertEqual(len(self.scatters), 2)
        solvers = {name for block in self.loaded.blocks for name in block.rows["solver"]}
        known = {(look["color"], look["marker"]) for look in map(looks.solver_look, solvers)}
        used = [{(line.get_color(), line.get_marker()) for line in ax.lines if line.get_marker() != "None"}
                for ax in self.figure.axes]
        for marks in used:
            self.assertLessEqual(marks, known)
        self.assertEqual(used[0], used[1])
        self.assertEqual(used[2], used[3])
        legend = {(line.get_color(), line.get_marker()) for line in self.figure.legends[0].get_lines()}
        self.assertEqual(legend, used[0] | used[2])

    def test_names_stay_inside_and_cover_neither_each_other_nor_a_point(self):
        for ax in self.scatters:
            boxes, frame = self.boxes(ax), ax.get_window_extent()
            self.assertGreater(len(boxes), 12)
            for text, box in boxes.items():
                self.assertTrue(frame.x0 <= box.x0 and box.x1 <= frame.x1 and frame.y0 <= box.y0 and
                                box.y1 <= frame.y1, f"{text.get_text()} leaves the axes")
            for (one, box), (other, second) in itertools.combinations(boxes.items(), 2):
                self.assertFalse(box.overlaps(second), f"{one.get_text()} lies on {other.get_text()}")
            for line in ax.lines:
                if line.get_marker() != "None":
                    point, = ax.transData.transform(line.get_xydata())
                    for text, box in boxes.items():
                        self.assertFalse(box.contains(*point), f"{text.get_text()} covers a point")

    def test_every_number_of_sweeps_is_written_and_the_fastest_cluster_is_named(self):
        for ax in self.scatters:
            texts = [text.get_text() for text in ax.texts]
            for sweeps in SWEEPS:
                number = f"{sweeps} sweeps" if sweeps == SWEEPS[0] else str(sweeps)
                self.assertIn(number, texts)
            cluster, = (text for text in texts if "monolithic" in text)
            self.assertEqual(set(cluster.split("\n")), {"exact", "monolithic", "schur"})

    def test_points_of_one_solver_are_joined_from_few_to_many_sweeps(self):
        color = looks.solver_look("pgs")["color"]
        joined, = (line for line in self.scatters[0].lines
                   if line.get_color() == color and len(line.get_xdata()) == len(SWEEPS))
        self.assertEqual(list(joined.get_xdata()), sorted(joined.get_xdata()))

    def test_names_stand_in_the_same_places_every_time(self):
        again = self.draw().axes[0]
        self.assertEqual([text.get_position() for text in self.scatters[0].texts],
                         [text.get_position() for text in again.texts])


class SpeedUpTest(FigureCase):

    def test_the_ideal_is_straight_and_no_mark_is_cut(self):
        write_tree(self.directory)
        rows = [dict(row, threads=2, t_s_ms=1.4 * row["t_s_ms"]) for row in rows_of("log_tower")]
        write_run(self.directory / "slower", rows, threads=2)
        figure = self.draw("speed_up")
        self.assertIn("the modelled time of a combination with as many workers is", self.caption)
        for ax in figure.axes:
            ideal, = (line for line in ax.lines if line.get_gid() == "ideal")
            workers = numpy.array([1, 2, 4, 8, 16, 32, 64])
            places = ax.transData.transform(numpy.column_stack([workers, workers]))
            directions = numpy.diff(places, axis=0)
            self.assertLess(numpy.ptp(numpy.arctan2(*directions.T)), 1e-9)
            numpy.testing.assert_allclose(ideal.get_xydata()[[0, -1]], [[1, 1], [64, 64]])
            for line in ax.lines:
                if line is not ideal:
                    self.assert_inside(ax, line)

    def test_the_caption_says_what_the_runs_charged(self):
        write_tree(self.directory)
        charge = "each charged what it costs to hand out an empty one"
        self.draw("speed_up")
        self.assertNotIn(charge, self.caption)
        for path in self.directory.rglob("manifest.json"):
            manifest = json.loads(path.read_text())
            manifest["machine"]["dispatch"] = {"task_us": 0.2}
            path.write_text(json.dumps(manifest))
        self.draw("speed_up")
        self.assertIn(charge, self.caption)

    def assert_inside(self, ax, line):
        frame, radius = ax.get_window_extent(), line.get_markersize() * ax.figure.dpi / 72 / 2
        for x, y in ax.transData.transform(line.get_xydata()):
            self.assertTrue(frame.x0 + radius <= x <= frame.x1 - radius, "a mark is cut at the side")
            self.assertTrue(frame.y0 + radius <= y <= frame.y1 - radius, "a mark is cut above or below")


class LadderTest(FigureCase):

    def test_texts_are_narrower_than_their_cells(self):
        lines = ["rung,parameter,value,solver,status,residual_m_per_s"]
        for solver in range(14):
            for rung, value in enumerate((0.0166667, 1e-12, 0.000123, 33333)):
                for harder in (value, value / 10):
                    lines.append(f"rung_{rung},dt,{harder},a_long_name_{solver},not_converged,1")
        (self.directory / "ladder.csv").write_text("\n".join(lines) + "\n")
        ax = self.draw("ladder").axes[0]
        (left, top), (right, bottom) = ax.transData.transform([(0, 0), (1, 1)])
        self.assertEqual(len(ax.texts), 4 * 14)
        for text in ax.texts:
            box = text.get_window_extent()
            self.assertLess(box.width, 0.95 * (right - left), text.get_text())
            self.assertLess(box.height, 0.95 * (top - bottom), text.get_text())


class CombinationTest(FigureCase):

    def test_an_arrowhead_marks_every_quartile_outside_the_panel_and_no_other(self):
        rows = rows_of("log_tower", ("mindp", "mix"), ("none", "fm"))
        for index, row in enumerate(rows):
            wild = (row["partitioner"], row["refiner"]) == ("mix", "fm")
            row["t_s_ms"] = (1 if index < len(rows) / 2 else 40) if wild else 10
        write_run(self.directory / "log_tower", rows)
        ax, = self.draw("figure3").axes
        top = ax.get_ylim()[1]
        heads = [line.get_xdata()[0] for line in ax.lines if line.get_marker() == "^"]
        uppers = [(x, high) for lines in ax.collections for (x, _), (_, high) in lines.get_segments()]
        self.assertEqual(heads, [x for x, high in uppers if high > top])
        self.assertEqual(len(heads), 1)


class InterfaceCostTest(FigureCase):

    def rows(self, scene, law, partitioners=("mindp", "bfs", "maxdp")):
        return [report_row(scene, step, partitioner, refiner, t_s_ms=law(cut), interface_rows=cut)
                for step in (9, 19) for cut, (partitioner, refiner) in zip(
                    (100, 110, 120, 400, 500, 600, 700, 800, 900),
                    itertools.product(partitioners, ("none", "kl", "fm")))]

    def test_every_scene_has_a_panel(self):
        for scene in SCENES:
            rows = self.rows(scene, lambda cut: 1 + cut**3 / 1e6)
            for row in rows:
                row["interface_rows"] = 0 if scene == "chain_drop" else row["interface_rows"]
                if scene == "log_tower":
                    row["t_s_ms"] = "nan"
            write_run(self.directory / scene, rows)
        axes = self.draw("interface_cost").axes
        self.assertEqual([ax.get_title(loc="left") for ax in axes], list(map(title, SCENES)))
        texts = [[text.get_text() for text in ax.texts] for ax in axes]
        self.assertEqual(texts, [["no constraint is cut"], ["no data"], [], []])

    def test_a_curve_is_fitted_only_where_several_partitioners_bear_it(self):
        write_run(self.directory / "rock_pile", self.rows("rock_pile", lambda cut: 1 + cut**3 / 1e6))
        # Only maxdp, which comes last, stands apart.
        write_run(self.directory / "log_tower",
                  self.rows("log_tower", lambda cut: 10 if cut < 700 else cut**2 / 1e4))
        log_tower, rock_pile = self.draw("interface_cost").axes
        self.assertIn("$R^2$ 1.00", rock_pile.get_legend().get_texts()[0].get_text())
        self.assertIn("not fitted", log_tower.get_legend().get_texts()[0].get_text())
        line = next(line for line in log_tower.lines if line.get_linestyle() == "--")
        (x, y), (far_x, far_y) = line.get_xydata()
        self.assertAlmostEqual(numpy.log(far_y / y) / numpy.log(far_x / x), 3)

    def test_too_few_points_bear_no_fit(self):
        write_run(self.directory / "rock_pile", self.rows("rock_pile", lambda cut: cut**3 / 1e6)[:2])
        loaded = data.load(self.directory, "schur")
        rows = loaded.main["rock_pile"][0].rows
        self.assertFalse(interface_cost.bears_a_fit(interface_cost.averages(rows)))


class RunsTest(FigureCase):

    def test_runs_that_differ_in_name_and_scene_only_share_a_line_and_a_machine_is_named_once(self):
        for name in ("run_30", "run_100"):
            write_run(self.directory / "more" / name, rows_of("log_tower"))
        write_run(self.directory / "more" / "run_5", rows_of("rock_pile"))
        write_run(self.directory / "other", rows_of("rock_pile"), steps=77)
        body = runs_body(data.load(self.directory, "schur").tree.experiments)
        self.assertEqual(body.count("Some_CPU"), 1)
        self.assertEqual(body.count("<tr>"), 3)
        self.assertIn("<td>more/ run_5, run_30, run_100</td><td>Log Tower, Rock Pile</td>", body)
        self.assertIn("<td>405 of 405</td>", body)


if __name__ == "__main__":
    unittest.main()
