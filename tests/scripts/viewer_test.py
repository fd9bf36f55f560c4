"""What the viewer puts into the page: every number within its stated rounding, thinned to a size."""
import base64
import gzip
import json
import pathlib
import re
import tempfile
import threading
import time
import unittest
from unittest import mock

import motion_data
import numpy
from synthetic import run_script

from cleave_scripts.motion.colours import EDGE_CASING, PART_COLOURS
from cleave_scripts.motion.recording import NO_PART, load_motion
from cleave_scripts.results.errors import ResultError
from cleave_scripts.viewer import page as viewer

TYPES = {"u8": "u1", "u16": "<u2", "i16": "<i2", "i32": "<i4", "f32": "<f4"}


def unpack(script):
    """Description and arrays of a recording, read as the page reads them."""
    packed = json.loads(script)
    data = gzip.decompress(base64.b64decode(packed["data"]))
    description = packed["description"]
    return description, {
        array["name"]: numpy.frombuffer(data, TYPES[array["type"]], array["count"], array["first"])
        for array in description["arrays"]
    }


def add_up(values, frames):
    values = values.reshape(frames, -1)
    return numpy.cumsum(values, axis=0, dtype=values.dtype)


def magnitudes(codes, limits):
    codes = codes.astype(float)
    values = limits["least"] * (limits["most"] / limits["least"])**((codes - 1) / 253)
    return numpy.where(codes == 0, 0, numpy.where(codes == 255, numpy.nan, values))


class MotionTest(unittest.TestCase):

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.directory = pathlib.Path(scratch.name)

    def motion(self, **options):
        return load_motion(motion_data.write_motion(self.directory, **options))


class PackTest(MotionTest):

    def test_poses_are_within_the_stated_rounding(self):
        motion = self.motion()
        description, arrays = unpack(viewer.pack(motion, 1))
        shape = motion.position.shape
        position = add_up(arrays["position"],
                          shape[0]).reshape(shape) * description["unit_m"] + description["origin_m"]
        self.assertLessEqual(abs(position - motion.position).max(), 0.51 * description["unit_m"])
        orientation = add_up(arrays["orientation"], shape[0]).reshape(motion.orientation.shape) / 32767
        self.assertLessEqual(abs(orientation - motion.orientation).max(), 0.51 / 32767)
        stated_mm = float(re.search(r"rounded to ([\d.e-]+) mm", description["note"]).group(1))
        self.assertAlmostEqual(stated_mm, 500 * description["unit_m"], delta=0.06 * stated_mm)

    def test_parts_graph_and_curves_are_exact(self):
        motion = self.motion()
        description, arrays = unpack(viewer.pack(motion, 1))
        part = arrays["part"].reshape(motion.measured["part"].shape)
        numpy.testing.assert_array_equal(numpy.where(part == description["no_part"], NO_PART, part),
                                         motion.measured["part"])
        numpy.testing.assert_array_equal(arrays["edge"].reshape(-1, 2), motion.measured.edge)
        numpy.testing.assert_array_equal(arrays["firstEdge"], motion.measured.first_edge)
        numpy.testing.assert_array_equal(arrays["tSMs"], motion.measured["t_s_ms"].ravel())
        numpy.testing.assert_array_equal(arrays["interfaceRows"], motion.measured["interface_rows"].ravel())
        self.assertEqual(description["combinations"][-1], "pgs")

    def test_colours_are_those_of_the_figures_and_follow_the_parts(self):
        motion = self.motion()
        part = motion.measured["part"]
        parts = numpy.arange(motion_data.BODIES) // 2
        for index in range(len(part)):
            part[index, 0] = numpy.random.default_rng(index).permutation(9)[parts]
        description, arrays = unpack(viewer.pack(motion, 1))
        numpy.testing.assert_allclose(description["part_colours"], PART_COLOURS)
        self.assertEqual(description["edge_casing_colour"], list(EDGE_CASING))
        colour = arrays["partColour"].reshape(part.shape)
        a, b = motion_data.EDGES.T

        def cut(of_body):
            return of_body[a] != of_body[b]

        for index in range(len(part)):
            numpy.testing.assert_array_equal(colour[index, 0], colour[0, 0])
            for combination in range(len(motion.combinations)):
                numpy.testing.assert_array_equal(cut(colour[index, combination]),
                                                 cut(part[index, combination]))
        island = arrays["islandColour"].reshape(motion.measured.island.shape)
        numpy.testing.assert_array_equal(island, 0)

    def test_many_parts_need_wider_numbers(self):

        def spread(file):
            file["measured/part"][0, 0, 0] = 255

        motion = self.motion(change=spread)
        description, arrays = unpack(viewer.pack(motion, 1))
        self.assertEqual((arrays["part"].dtype, description["no_part"]), (numpy.dtype("u2"), NO_PART))
        numpy.testing.assert_array_equal(arrays["part"], motion.measured["part"].ravel())

    def test_magnitudes_are_within_half_a_level(self):
        motion = self.motion()
        description, arrays = unpack(viewer.pack(motion, 1))
        for name, column in (("residual", "residual_m_per_s"), ("impulse", "largest_impulse_n_s")):
            limits, expected = description["ranges"][name], motion.measured[column].ravel().astype(float)
            found = magnitudes(arrays[name], limits)
            positive = expected > 0
            half_level = (limits["most"] / limits["least"])**(0.51 / 253)
            numpy.testing.assert_array_equal(numpy.isnan(found), numpy.isnan(expected))
            numpy.testing.assert_array_equal(found[~positive & ~numpy.isnan(expected)], 0)
            self.assertLessEqual((found[positive] / expected[positive]).max(), half_level)
            self.assertGreaterEqual((found[positive] / expected[positive]).min(), 1 / half_level)

    def test_thinning_keeps_the_last_measured_step_and_all_curves(self):
        motion = self.motion()
        description, arrays = unpack(viewer.pack(motion, 4))
        self.assertEqual(arrays["measuredStep"].tolist(), [5, 17, 29])
        self.assertEqual(arrays["keptOfAll"].tolist(), [1, 5, 9])
        self.assertEqual(arrays["curveStep"].tolist(), motion.measured.step.tolist())
        self.assertTrue({5, 17, 29, 0, 4, 8} <= set(arrays["step"].tolist()))
        self.assertLess(len(arrays["step"]), 12)
        self.assertIn("one of 4 measured steps and one of 4 steps", description["note"])
        frame = arrays["step"].tolist().index(17)
        position = add_up(arrays["position"], len(arrays["step"]))[frame].reshape(-1, 3)
        numpy.testing.assert_allclose(position * description["unit_m"] + description["origin_m"],
                                      motion.position[17],
                                      atol=description["unit_m"])

    def test_a_run_that_ended_early_is_told(self):
        self.assertIn("30 of 90 steps", unpack(viewer.pack(self.motion(steps=90), 1))[0]["note"])
        self.assertNotIn("ended early", unpack(viewer.pack(self.motion(), 1))[0]["note"])

    def test_hulls_come_as_triangles(self):
        geoms = unpack(viewer.pack(self.motion(), 1))[0]["geoms"]
        self.assertEqual([len(geom.get("triangles_m", [])) for geom in geoms], [0, 0, 0, 0, 12, 0, 0])


class SectionTest(MotionTest):

    def test_without_a_recording_there_is_a_note(self):
        self.assertEqual(viewer.viewer_section(self.directory), viewer.NO_MOTION)

    def test_the_section_needs_nothing_beside_it(self):
        self.motion()
        section = viewer.viewer_section(self.directory)
        self.assertNotRegex(section, r"""(src|href)\s*=\s*["']?(?!data:)\w""")
        self.assertEqual(section.count("class=\"cleave-recording\""), 1)

    def test_recordings_are_thinned_until_the_page_fits(self):
        for name in ("a", "b"):
            motion_data.write_motion(self.directory / name)
        full = [
            script for script in viewer.viewer_section(self.directory).split("<script")
            if "data-name" in script
        ]
        self.assertEqual(len(full), 2)
        most = 0.9 * sum(map(len, full))
        thin = [
            script for script in viewer.viewer_section(self.directory, page_bytes=most).split("<script")
            if "data-name" in script
        ]
        self.assertLess(sum(map(len, thin)), 1.01 * most)
        self.assertTrue(all("one of" in script for script in thin))

    def test_a_broken_recording_is_an_error_with_its_name(self):
        motion_data.write_motion(self.directory, change=lambda file: file.pop("position"))
        with self.assertRaisesRegex(ResultError, "motion.h5: dataset position is missing"):
            viewer.viewer_section(self.directory)

    def test_missing_and_failing_tools_are_named(self):
        with self.assertRaisesRegex(ResultError, "no_such_tool is not installed"):
            viewer._run(["no_such_tool"], "bundling")
        with self.assertRaisesRegex(ResultError, "bundling failed: broken"):
            viewer._run(["sh", "-c", "echo broken >&2; exit 1"], "bundling")
        with mock.patch.object(viewer, "SOURCES", self.directory):
            (self.directory / "package.json").write_text("{")
            with self.assertRaisesRegex(ResultError, "installing three.js and esbuild from npm"):
                viewer.build_script()

    def test_processes_that_start_together_install_the_packages_once(self):
        (self.directory / "package.json").write_text("{}")
        installed = []

        def slow_install(*_):
            installed.append((self.directory / "node_modules").exists())
            time.sleep(0.2)
            (self.directory / "node_modules").mkdir()
            (self.directory / "node_modules" / ".package-lock.json").touch()

        with mock.patch.multiple(viewer, SOURCES=self.directory, _run=slow_install):
            threads = [threading.Thread(target=viewer._install_packages) for _ in range(4)]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
        self.assertEqual(installed, [False])

    def test_versions_are_fixed(self):
        package = json.loads((viewer.SOURCES / "package.json").read_text())
        lock = json.loads((viewer.SOURCES / "package-lock.json").read_text())
        for name, version in {**package["dependencies"], **package["devDependencies"]}.items():
            self.assertRegex(version, r"^\d+\.\d+\.\d+$")
            self.assertEqual(lock["packages"][f"node_modules/{name}"]["version"], version)
            self.assertIn("integrity", lock["packages"][f"node_modules/{name}"])

    def test_the_command(self):
        result = run_script("view", self.directory)
        self.assertEqual((result.returncode, len(result.stderr.splitlines())), (1, 1))
        self.assertIn("no motion.h5", result.stderr)
        self.motion()
        result = run_script("view", self.directory, "--out", self.directory / "page.html")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("cleave-viewer", (self.directory / "page.html").read_text())


if __name__ == "__main__":
    unittest.main()
