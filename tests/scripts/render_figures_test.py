"""scripts/render_figures: pictures that show what they should, marked gaps, clear errors."""
import argparse
import pathlib
import tempfile
import unittest
import unittest.mock

import matplotlib.image
import motion_data
import numpy
from browser import blank_reason
from synthetic import run_script

from cleave_scripts.motion import figure2
from cleave_scripts.motion.colours import EDGE, NODE, PART_COLOURS
from cleave_scripts.motion.picture_sheets import best_cell, cells_of, colours_of_cells, names_of
from cleave_scripts.motion.pictures import Stage, picture_of_bodies, picture_of_parts, picture_with_graph
from cleave_scripts.motion.povray_scene import CONSTANT_LIGHT, Camera, graph, render
from cleave_scripts.motion.recording import load_motion
from cleave_scripts.results.errors import ResultError
from cleave_scripts.results.paper import COMBINATIONS

SIZE = (160, 130)
LAST = motion_data.STEPS - 1


def hue_share(picture, colour):
    """Share of the picture that has about the hue of a colour."""

    def chroma(values):
        values = numpy.asarray(values) - numpy.mean(values, axis=-1, keepdims=True)
        return values / numpy.maximum(numpy.linalg.norm(values, axis=-1, keepdims=True), 0.12)

    return float((chroma(picture) @ chroma(colour) > 0.94).mean())


class Scratch(unittest.TestCase):

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.directory = pathlib.Path(scratch.name)

    def motion(self, **options):
        return load_motion(motion_data.write_motion(self.directory / "run", **options))


class PictureTest(Scratch):

    def test_a_graph_is_blue_and_red_over_the_bodies(self):
        for walls in (False, True):
            motion = self.motion(walls=walls)
            stage = Stage(motion, [LAST], SIZE)
            plain, graph = picture_of_bodies(stage, LAST), picture_with_graph(stage, LAST, 9)
            for picture in (plain, graph):
                self.assertEqual(picture.shape, (SIZE[1], SIZE[0], 3))
                self.assertIsNone(blank_reason(picture))
            for colour in (NODE, EDGE):
                self.assertLess(hue_share(plain, colour), 1e-4)
                self.assertGreater(hue_share(graph, colour), 2e-3)

    def test_parts_have_their_colours_and_cut_edges_are_red(self):
        motion = self.motion()
        stage = Stage(motion, [LAST], SIZE)
        picture = picture_of_parts(stage, LAST, 9, 0, motion.measured["part"][9, 0])  # two parts
        for part in (0, 1):
            self.assertGreater(hue_share(picture, PART_COLOURS[part]), 5e-3)
        self.assertGreater(hue_share(picture, EDGE), 2e-3)
        motion.measured["part"][9, 0] = 0
        whole = picture_of_parts(stage, LAST, 9, 0, motion.measured["part"][9, 0])
        self.assertLess(hue_share(whole, PART_COLOURS[1]), 1e-3)
        self.assertLess(hue_share(whole, EDGE), 1e-4)

    def test_edges_have_a_casing_that_is_wider_than_they_are(self):
        stage = Stage(self.motion(), [LAST], SIZE)
        black, grey = (0, 0, 0), "background { srgb <0.5, 0.5, 0.5> } "
        centres = stage.camera.target + numpy.array([(-0.5, 0, 0), (0.5, 0, 0)])
        picture = render(CONSTANT_LIGHT + stage.camera.povray(stage.aspect) + grey +
                         graph(stage.camera, centres, [(0, 1)], (0.05, black)), *SIZE)
        column = picture[:, SIZE[0] // 2].mean(axis=-1)
        line, casing = column < 0.25, column > 0.9
        self.assertGreater(line.sum(), 2)
        self.assertGreater(casing.sum(), line.sum() / 2)
        self.assertTrue(casing[line.argmax() - 2] and casing[len(line) - line[::-1].argmax() + 1])

    def test_the_same_recording_gives_the_same_picture(self):
        stage = Stage(self.motion(walls=True), [LAST], SIZE)
        numpy.testing.assert_array_equal(picture_with_graph(stage, LAST, 9),
                                         picture_with_graph(stage, LAST, 9))

    def test_every_shape_is_drawn(self):
        motion = self.motion()
        stage = Stage(motion, [LAST], SIZE, gathered_light=False)
        full = picture_of_bodies(stage, LAST)
        for geom in [geom for geom in motion.geoms if geom.body >= 0]:
            motion.geoms.remove(geom)
            difference = abs(picture_of_bodies(stage, LAST) - full).max(axis=-1) > 0.05
            self.assertGreater(difference.mean(), 2e-3, geom.kind)
            motion.geoms.append(geom)

    def test_a_camera_just_holds_its_points(self):
        random = numpy.random.default_rng(2)
        for aspect in (0.6, 1, 1.7):
            points, radii = random.normal(size=(40, 3)) * (5, 2, 1), random.uniform(0.1, 0.4, 40)
            camera = Camera.around(points,
                                   radii,
                                   azimuth=random.uniform(-180, 180),
                                   elevation=30,
                                   aspect=aspect,
                                   margin=1)
            right = numpy.cross([0, 0, 1], camera.back)
            right /= numpy.linalg.norm(right)
            up = numpy.cross(camera.back, right)
            relative = points - camera.eye
            depth = -(relative @ camera.back)
            half = numpy.tan(numpy.radians(13))
            x = (abs(relative @ right) + radii) / (half * depth)
            y = (abs(relative @ up) + radii) / (half / aspect * depth)
            self.assertLess(max(x.max(), y.max()), 1 + 1e-9)
            self.assertGreater(max(x.max(), y.max()), 1 - 1e-9)

    def test_parts_of_figure_2_have_one_colour_in_all_cells(self):
        motion = self.motion()
        parts = numpy.arange(motion_data.BODIES) // 2
        for position in range(len(COMBINATIONS)):
            motion.measured["part"][9, position] = numpy.random.default_rng(position).permutation(9)[parts]
        colours = colours_of_cells(motion, 9, cells_of(motion))
        self.assertEqual(len(colours), len(COMBINATIONS))
        for colour in colours.values():
            numpy.testing.assert_array_equal(colour, colours["mindp", "none"])

    def test_figure_2_shows_what_was_recorded_whoever_it_is(self):
        labels = ["stripes@width=5+none+schur", "mr@tau-mr=1e+06+swap+schur", "mix+none+schur", "-+-+relax@sweeps=30"]
        motion_data.write_motion(self.directory, labels=labels)
        motion = load_motion(self.directory / "motion.h5")
        self.assertEqual(motion.combinations[1], ("mr@tau-mr=1e+06", "swap", "schur"))
        self.assertEqual(names_of(cells_of(motion)), (["mix", "stripes@width=5", "mr@tau-mr=1e+06"], ["none", "swap"]))
        self.assertEqual(best_cell(cells_of(motion)), 0)  # the paper's is not there
        with unittest.mock.patch.object(figure2, "_pictures", return_value={}):
            figure = figure2.draw([motion], argparse.Namespace(width=100))
        self.addCleanup(figure2.pyplot.close, figure)
        where = matplotlib.rcParams["axes.titlelocation"]
        self.assertEqual([axes.get_title(where) for axes in figure.axes[:3]], ["mix", "stripes@width=5", "mr@tau-mr=1e+06"])
        self.assertEqual(len(figure.axes), 6)

    def test_what_povray_does_not_understand_is_an_error(self):
        with self.assertRaisesRegex(ResultError, "povray failed: .*rror"):
            render("sphere { nonsense }", 20, 20)


class CommandTest(Scratch):

    def render(self, *arguments):
        return run_script("render_figures", self.directory, "--width", 100, *arguments)

    def test_everything_is_made_where_everything_was_recorded(self):
        for scene in ("chain_drop", "rock_pile", "log_tower"):
            motion_data.write_motion(self.directory / scene,
                                     scene=scene,
                                     labels=motion_data.combinations(),
                                     walls=True)
        result = self.render("--every", 10)
        self.assertEqual(result.returncode, 0, result.stderr)
        figures = self.directory / "figures"
        self.assertEqual(sorted(path.name for path in figures.iterdir()), [
            "figure1.pdf", "figure1.png", "figure1.txt", "figure2.pdf", "figure2.png", "figure2.txt",
            "film_strip.png"
        ])
        for name in ("figure1", "figure2", "film_strip"):
            self.assertIsNone(blank_reason(matplotlib.image.imread(figures / f"{name}.png")[..., :3]), name)
        self.assertEqual(result.stderr.count("film strip:"), 9)  # three scenes by steps 0, 10, 20
        self.assertEqual(result.stderr.count("figure 2:"), len(COMBINATIONS))

    def test_what_was_not_recorded_is_a_gap(self):
        motion_data.write_motion(self.directory, labels=["mix+fm+schur", "bfs+none+schur"])
        result = self.render("--only", "figure1,figure2", "--out", self.directory / "elsewhere")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stderr.count("figure 1:"), 1)
        self.assertEqual(result.stderr.count("figure 2:"), 2)
        self.assertTrue((self.directory / "elsewhere" / "figure2.pdf").exists())
        self.assertFalse((self.directory / "figures").exists())

    def test_a_run_without_a_measured_step_is_a_gap(self):

        def empty(file):
            for name in ("step", "edge_count"):
                del file[f"measured/{name}"]
                file[f"measured/{name}"] = numpy.zeros(0, "i4")

        motion_data.write_motion(self.directory, change=empty)
        result = self.render("--every", 29)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stderr.count("figure"), result.stderr.count("render_figures"))

    def test_bad_input_is_one_line_and_exit_one(self):
        self.assert_refused("no motion.h5 in it or below")
        (self.directory / "motion.h5").write_text("x")
        self.assert_refused("not a readable HDF5 file")
        motion_data.write_motion(self.directory)
        self.assert_refused("--only has 'figure9', expected some of figure1,figure2,film_strip; did you mean figure", "--only",
                            "figure9")
        self.assert_refused("--every is '0', expected a whole number from 1", "--every", 0)
        self.assert_refused("--columns is '0', expected a whole number from 1 to 1000", "--columns", 0)

    def assert_refused(self, words, *arguments):
        result = self.render(*arguments)
        self.assertEqual((result.returncode, len(result.stderr.splitlines())), (1, 1), result.stderr)
        self.assertIn(words, result.stderr)


if __name__ == "__main__":
    unittest.main()
