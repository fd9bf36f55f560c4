"""The viewer in headless Chromium, driven by mouse and keyboard as a person would."""
import pathlib
import tempfile
import unittest

import motion_data
import numpy
from browser import Browser, blank_reason

from cleave_scripts.viewer import page as viewer

WIDTH, HEIGHT = 900, 1000
CANVAS = ".cleave-canvas"
READY = "document.querySelector('.cleave-viewer').dataset.state === 'ready' && it().framesDrawn > 0"
DEFINE = "window.it = () => document.querySelector('.cleave-viewer').cleaveViewer"

# How far the corners of the bodies reach to the right, up, to the left and down; 1 is the edge of the canvas.
EXTREMES = """(() => {
    const {mesh, bones, position: at} = it().bodies, {position, skinIndex} = mesh.geometry.attributes;
    const most = [-9, -9, -9, -9];
    for (let i = 0; i < position.count; ++i) {
        const bone = bones[skinIndex.getX(i)].matrixWorld;
        at.fromBufferAttribute(position, i).applyMatrix4(bone).project(it().stage.camera);
        [at.x, at.y, -at.x, -at.y].forEach((value, k) => most[k] = Math.max(most[k], value));
    }
    return most;
})()"""


class ViewerTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.browser = Browser(WIDTH, HEIGHT)
        cls.addClassCleanup(cls.browser.__exit__)

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.directory = pathlib.Path(scratch.name)
        self.browser.problems.clear()

    def open(self, *names, **options):
        for name in names or ("run",):
            motion_data.write_motion(self.directory / name, **options)
        page = self.directory / "page.html"
        page.write_text(viewer.viewer_page(self.directory), encoding="utf-8")
        self.browser.open(page)
        self.browser.wait_for("document.readyState === 'complete'")
        self.browser.value(DEFINE)
        self.browser.wait_for(READY)

    def settle(self):
        """Waits until what was asked for is drawn."""
        self.browser.value("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")

    def status(self):
        self.settle()
        return self.browser.value("document.querySelector('[data-use=status]').textContent")

    def canvas(self):
        self.settle()
        return self.browser.picture(CANVAS)

    def choose(self, use, name):
        self.browser.value(f"""(() => {{
            const list = document.querySelector("[data-use={use}]");
            list.selectedIndex = [...list.options].findIndex(option => option.text === {name!r});
            list.dispatchEvent(new Event("change"));
        }})()""")

    def assert_differ(self, a, b):
        self.assertGreater((abs(a - b).max(axis=-1) > 0.1).mean(), 0.002)

    def test_there_is_something_to_see_and_nothing_goes_wrong(self):
        for walls in (False, True):
            self.open(walls=walls)
            self.assertIsNone(blank_reason(self.canvas()))
            self.assertIsNone(blank_reason(self.browser.picture(".cleave-curves"), 0.02, 16))
        self.assertEqual(self.browser.problems, [])

    def test_the_check_for_blank_pictures_fails_on_a_viewer_that_draws_nothing(self):
        self.open()
        self.browser.value(
            "it().bodies.mesh.visible = false, it().stage.world.clear(), it().ui.graph.click()")
        self.assertIsNotNone(blank_reason(self.canvas()))

    def test_keys_step_and_play(self):
        self.open()
        frames = []
        self.assertEqual(self.browser.value("it().frame"), 29)  # it opens at the end
        for key, shift in (("Home", False), ("ArrowRight", False), ("ArrowRight", True), ("ArrowLeft", False),
                           ("End", False), ("ArrowRight", False), ("Home", False)):
            self.browser.press(key, shift)
            self.settle()
            frames.append(self.browser.value("it().frame"))
        self.assertEqual(frames, [0, 1, 11, 10, 29, 29, 0])
        self.browser.press(" ")
        self.browser.wait_for("it().frame > 3")
        self.browser.press(" ")
        frame = self.browser.value("it().frame")
        self.assertEqual(self.browser.value("document.querySelector('[data-use=play]').textContent"), "Play")
        self.settle()
        self.assertEqual(self.browser.value("it().frame"), frame)
        self.assertEqual(self.browser.problems, [])

    def test_a_click_turns_the_keys_to_the_viewer(self):
        self.open()
        self.browser.value("document.activeElement.blur()")
        self.browser.press("Home")
        self.settle()
        self.assertEqual(self.browser.value("it().frame"), 29)
        x, y, width, height = self.browser.place(CANVAS)
        self.browser.click(x + 5, y + 5)
        self.browser.press("Home")
        self.settle()
        self.assertEqual(self.browser.value("it().frame"), 0)

    def test_playing_ends_at_the_last_step_and_starts_again_from_the_first(self):
        self.open()
        self.browser.press("End")
        self.browser.press("ArrowLeft")
        self.browser.press(" ")
        self.browser.wait_for("it().frame === 29 && !it().playing")
        self.browser.press(" ")
        self.browser.wait_for("it().playing && it().frame < 25")

    def test_the_slider_moves_the_bodies(self):
        self.open()
        before = self.canvas()
        x, y, width, height = self.browser.place("[data-use=step]")
        self.browser.click(x + width / 2, y + height / 2)
        self.settle()
        self.assertAlmostEqual(self.browser.value("it().frame"), 14.5, delta=1.5)
        self.assert_differ(before, self.canvas())
        self.assertRegex(self.status(), r"^step 1[3-6] of 30, ")

    def test_a_click_on_the_curves_goes_to_that_step(self):
        self.open()
        x, y, _, _ = self.browser.place(".cleave-curves")
        self.browser.click(x + self.browser.value("it().plots.x(20)"), y + 60)
        self.assertRegex(self.status(), r"^step 20 of 30")

    def test_the_combination_list_changes_parts_rows_and_colours(self):
        self.open()
        self.browser.press("End")
        self.choose("combination", "mindp + none, schur")
        first, picture = self.status(), self.canvas()
        self.choose("combination", "mindp + kl, schur")
        second = self.status()
        part = [motion_data.part_of(9, combination) for combination in (0, 1)]
        for text, parts in zip((first, second), part):
            a, b = motion_data.EDGES.T
            cut = int((parts[a] != parts[b]).sum())
            self.assertIn(f"{len(set(parts))} parts, {cut} of 6 edges cut, {3 * cut} interface rows", text)
        self.assert_differ(picture, self.canvas())
        self.choose("combination", "pgs")
        self.assertIn("no parts", self.status())
        self.browser.value("document.querySelector('.cleave-viewer').focus()")
        self.browser.press("ArrowDown")  # from the last to the first
        self.assertEqual(self.status(), first)
        self.assertEqual(self.browser.problems, [])

    def test_a_cell_that_was_not_solved_is_marked(self):

        def fail(file):
            file["measured/ok"][9, 0] = 0

        self.open(change=fail)
        self.browser.press("End")
        self.assertIn("NOT SOLVED", self.status())
        self.browser.press("ArrowDown")
        self.assertNotIn("NOT SOLVED", self.status())

    def test_every_colouring_shows_another_picture_and_its_legend(self):
        self.open()
        self.browser.press("End")
        pictures, legends = [], []
        for name in ("part", "island", "residual", "impulse"):
            self.choose("colour", name)
            pictures.append(self.canvas())
            legends.append(self.browser.value("document.querySelector('[data-use=legend]').textContent"))
        for i, picture in enumerate(pictures):
            for other in pictures[:i]:
                self.assert_differ(picture, other)
        self.assertEqual(legends[:2],
                         ["a colour a part; parts that share constraints differ",
                          "a colour an island; near ones differ"])
        self.assertRegex(legends[2], r"m/s, logarithmic")
        self.assertRegex(legends[3], r"N s, logarithmic")

    def test_edges_are_red_between_parts_and_where_there_are_no_parts(self):
        self.open()
        self.browser.press("End")
        a, b = motion_data.EDGES.T
        part = motion_data.part_of(9, 0)
        for name, red in (("mindp + none, schur", part[a] != part[b]), ("pgs", a >= 0)):
            self.choose("combination", name)
            self.settle()
            shown = self.browser.value("""(() => {
                const {colour} = it().graph.sticks.geometry.attributes;
                return Array.from({length: 6}, (_, edge) => colour.getX(4 * edge) > 3 * colour.getY(4 * edge));
            })()""")
            self.assertEqual(shown, red.tolist(), name)
            cased = self.browser.value("""(() => {
                const {cased} = it().graph.casings.geometry.attributes;
                return Array.from({length: 6}, (_, edge) => cased.getX(4 * edge));
            })()""")
            self.assertEqual(cased, red.astype(int).tolist(), name)

    def test_at_any_width_and_step_the_bodies_just_fit_the_canvas(self):
        for width in (1280, 420):
            self.browser.resize(width, HEIGHT)
            self.addCleanup(self.browser.resize, WIDTH, HEIGHT)
            self.open()
            for key in ("End", "Home"):
                self.browser.press(key)
                self.settle()
                most = self.browser.value(EXTREMES)
                self.assertLess(max(most), 1, (width, key))
                self.assertGreater(max(most), 0.94, (width, key))
                tight = int(numpy.argmax(most))
                self.assertAlmostEqual(most[tight], most[tight - 2], delta=0.01)  # the side opposite

    def test_the_view_follows_the_bodies_until_it_is_turned(self):
        self.open()
        place = "it().stage.camera.position.toArray()"
        at_end = self.browser.value(place)
        self.browser.press("Home")
        self.settle()
        at_start = self.browser.value(place)
        self.assertNotEqual(at_start, at_end)
        x, y, width, height = self.browser.place(CANVAS)
        self.browser.drag(x + width / 2, y + height / 2, x + width / 2 + 120, y + height / 2)
        self.settle()
        turned = self.browser.value(place)
        self.browser.press("End")
        self.settle()
        self.assertEqual(self.browser.value(place), turned)
        self.browser.press("r")
        self.settle()
        numpy.testing.assert_allclose(self.browser.value(place), at_end)

    def test_edges_between_parts_have_a_casing(self):
        self.open()
        self.browser.press("End")
        cased = self.canvas()
        self.browser.value("(() => { it().graph.casings.visible = false; it().change(); })()")
        bare = self.canvas()
        white = (cased > 0.99).all(axis=-1) & ~(bare > 0.99).all(axis=-1)
        self.assertGreater(white.mean(), 0.001)
        # And nothing else changes: it covers no line.
        self.assertTrue((white | (abs(cased - bare).max(axis=-1) < 0.02)).all())
        red = (bare[..., 0] > 0.4) & (bare[..., 1:] < 0.15).all(axis=-1)
        self.assertGreater(red.mean(), 0.001)
        self.assertFalse((white & red).any())

    def test_a_slow_machine_gets_fewer_pixels_while_it_plays_and_all_of_them_afterwards(self):
        self.open()
        full = self.browser.value("it().ui.canvas.width")
        # As if every picture had taken a tenth of a second.
        self.browser.value("(() => { let at = 0; it().pace.note = function() { "
                           "Object.getPrototypeOf(this).note.call(this, at += 100); }; })()")
        self.choose("speed", "0.1")
        self.browser.press(" ")
        self.browser.wait_for("it().stage.share === 0.5")
        self.assertAlmostEqual(self.browser.value("it().ui.canvas.width"), full / 2, delta=1)
        self.assertIn("fewer pixels", self.browser.value("it().ui.note.textContent"))
        self.browser.press(" ")
        self.settle()
        self.assertEqual(self.browser.value("it().ui.canvas.width"), full)
        self.assertEqual(self.browser.problems, [])

    def test_the_graph_can_be_left_out(self):
        self.open()
        self.browser.press("End")
        before = self.canvas()
        self.browser.press("g")
        self.assert_differ(before, self.canvas())
        self.browser.press("g")
        numpy.testing.assert_allclose(self.canvas(), before, atol=0.02)

    def test_the_mouse_turns_the_view_and_r_turns_it_back(self):
        self.open()
        before = self.canvas()
        x, y, width, height = self.browser.place(CANVAS)
        self.browser.drag(x + width / 2, y + height / 2, x + width / 2 + 120, y + height / 2 + 30)
        self.assert_differ(before, self.canvas())
        self.browser.press("r")
        numpy.testing.assert_allclose(self.canvas(), before, atol=0.02)

    def test_a_click_tells_about_the_body(self):
        self.open()
        self.browser.press("End")
        self.settle()
        x, y, width, height = self.browser.place(CANVAS)
        place = self.browser.value("""(() => {
            const {bones, position} = it().bodies;
            const at = position.clone().setFromMatrixPosition(bones[1].matrixWorld);
            at.project(it().stage.camera);
            return [(at.x + 1) / 2, (1 - at.y) / 2];
        })()""")
        self.browser.click(x + place[0] * width, y + place[1] * height)
        self.assertRegex(self.status(),
                         r"^body 1: 100 kg, part \d, island 0, residual .* m/s, largest impulse .* N s")

    def test_shadows_can_be_switched(self):
        self.open()
        self.assertFalse(
            self.browser.value("document.querySelector('[data-use=shadows]').checked"))  # in software
        self.assertIn("without a graphics card",
                      self.browser.value("document.querySelector('[data-use=note]').textContent"))
        before = self.canvas()
        self.browser.value("document.querySelector('[data-use=shadows]').click()")
        self.assert_differ(before, self.canvas())
        self.assertEqual(self.browser.problems, [])

    def test_several_recordings_can_be_chosen(self):
        self.open("first", "second")
        before = self.canvas()
        self.browser.press("Home")
        self.choose("recording", "second: rock_pile, 6 bodies, seed 1")
        self.browser.wait_for(f"{READY} && it().frame === 29 && it().ui.recording.selectedIndex === 1")
        numpy.testing.assert_allclose(self.canvas(), before, atol=0.02)
        self.assertEqual(self.browser.problems, [])

    def test_without_webgl_the_page_says_so(self):
        motion_data.write_motion(self.directory)
        page = self.directory / "page.html"
        text = viewer.viewer_page(self.directory)
        page.write_text(
            text.replace("<body>",
                         "<body><script>HTMLCanvasElement.prototype.getContext = () => null;</script>"))
        self.browser.open(page)
        self.browser.wait_for("document.querySelector('.cleave-viewer')?.dataset.state === 'failed'")
        self.assertIn("offers no WebGL",
                      self.browser.value("document.querySelector('.cleave-message').textContent"))
        self.assertIn("WebGL", " ".join(self.browser.problems))  # what other tests look for is seen


if __name__ == "__main__":
    unittest.main()
