"""Reading of motion.h5, and the geometry that pictures are made of."""
import pathlib
import tempfile
import unittest

import h5py
import motion_data
import numpy

from cleave_scripts.motion.recording import find_recordings, load_motion
from cleave_scripts.motion.shapes import (conjugate, hull_triangles, multiply, plane_polygons, relative_pose,
                                          rotation_matrix, world_pose)
from cleave_scripts.results.errors import ResultError


def random_turns(count, seed=1):
    turns = numpy.random.default_rng(seed).normal(size=(count, 4))
    return turns / numpy.linalg.norm(turns, axis=1)[:, None]


def support_m(geom, direction):
    """How far a shape at the origin reaches in some directions."""
    along, aside = abs(direction[:, 2]), numpy.linalg.norm(direction[:, :2], axis=1)
    return {
        "box": lambda: abs(direction) @ geom.size / 2,
        "sphere": lambda: geom.size[0],
        "capsule": lambda: geom.size[0] + along * geom.size[1] / 2,
        "cylinder": lambda: geom.size[0] * aside + along * geom.size[1] / 2,
        "convex": lambda: (geom.corners @ direction.T).max(axis=0),
    }[geom.kind]()


class ReadTest(unittest.TestCase):

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.directory = pathlib.Path(scratch.name)

    def load(self, **options):
        return load_motion(motion_data.write_motion(self.directory, **options))

    def assert_error(self, words, **options):
        with self.assertRaises(ResultError) as caught:
            self.load(**options)
        self.assertEqual(len(str(caught.exception).splitlines()), 1)
        self.assertIn(str(self.directory / "motion.h5"), str(caught.exception))
        self.assertIn(words, str(caught.exception))

    def test_everything_is_there(self):
        motion = self.load()
        self.assertEqual((motion.scene, motion.bodies, len(motion.step)), ("rock_pile", 6, motion_data.STEPS))
        self.assertEqual(motion.combinations[0], ("mindp", "none", "schur"))
        self.assertEqual(motion.combinations[-1], ("-", "-", "pgs"))
        numpy.testing.assert_array_equal(motion.position, motion_data.positions())
        numpy.testing.assert_array_equal(motion.measured.edges(4), motion_data.EDGES)
        self.assertEqual([geom.kind for geom in motion.geoms][-1], "plane")

    def test_texts_of_fixed_length_are_texts(self):

        def fix_lengths(file):
            for name in ("schema", "run_id", "scene", "combinations"):
                text = file.attrs[name].encode()
                file.attrs.create(name, text, dtype=h5py.string_dtype("utf-8", len(text)))

        motion = self.load(change=fix_lengths)
        self.assertEqual((motion.scene, motion.attributes["run_id"]), ("rock_pile", "0123456789abcdef"))

    def test_geoms_come_in_the_frame_of_their_body(self):
        geoms = self.load().geoms
        for geom in geoms[:6]:
            numpy.testing.assert_allclose(geom.position, 0, atol=1e-6)
            numpy.testing.assert_allclose(geom.orientation, (1, 0, 0, 0), atol=1e-6)
        numpy.testing.assert_allclose(geoms[6].position, (0.3, 0, 0), atol=1e-6)

    def test_measured_index_is_the_last_one_up_to_a_step(self):
        motion = self.load()  # measured: 2, 5, 8, ...
        self.assertEqual([motion.measured_index(step) for step in (1, 2, 4, 5, 99)], [None, 0, 0, 1, 9])

    def test_recordings_are_found_at_any_depth(self):
        for name in ("b", "a/deep"):
            motion_data.write_motion(self.directory / name)
        self.assertEqual([str(path.relative_to(self.directory)) for path in find_recordings(self.directory).values()],
                         ["a/deep/motion.h5", "b/motion.h5"])

    def test_a_killed_run_is_read_as_far_as_its_steps_are_complete(self):

        def cut(file):
            for name, length in (("step", 16), ("measured/step", 4)):
                values = file[name][:length]
                del file[name]
                file[name] = values

        motion = self.load(change=cut)
        self.assertEqual((motion.position.shape, motion.measured["part"].shape), ((16, 6, 3), (4, 16, 6)))
        self.assertEqual(len(motion.measured.edge), 4 * len(motion_data.EDGES))

    def test_a_file_that_is_being_written_can_be_read(self):
        path = self.directory / "motion.h5"
        with h5py.File(path, "w", libver="latest") as file:
            file.attrs["schema"] = "cleave-motion-1"
            file.create_dataset("step", (0,), "i4", maxshape=(None,), chunks=(16,))
            file.swmr_mode = True
            with self.assertRaisesRegex(ResultError, "attribute run_id is missing"):  # so it was opened
                load_motion(path)

    def test_errors_name_the_file_and_what_is_wrong(self):
        self.assert_error("schema = other, expected cleave-motion-1", schema="other")
        self.assert_error("dataset measured/part is missing", change=lambda file: file.pop("measured/part"))
        self.assert_error("attribute h_s is missing", change=lambda file: file.attrs.pop("h_s"))

        def replace(name, values):

            def change(file):
                del file[name]
                file[name] = values

            return change

        self.assert_error("no step is complete", change=replace("step", numpy.zeros(0, "i4")))
        self.assert_error("shape of position = (29, 6, 3)",
                          change=replace("position",
                                         motion_data.positions()[1:]))
        self.assert_error("names body 6 of 6", change=replace("measured/edge", numpy.full((60, 2), 6, "u2")))
        self.assert_error("geom_type holds 9", change=replace("shape/geom_type", numpy.full(8, 9, "u1")))
        (self.directory / "motion.h5").write_text("no such thing")
        with self.assertRaisesRegex(ResultError, "not a readable HDF5 file"):
            load_motion(self.directory / "motion.h5")
        with self.assertRaisesRegex(ResultError, "No such file"):
            load_motion(self.directory / "missing.h5")


class GeometryTest(unittest.TestCase):

    def test_turns_multiply_as_their_matrices_do(self):
        for a, b in zip(random_turns(20, 1), random_turns(20, 2)):
            numpy.testing.assert_allclose(rotation_matrix(multiply(a, b)),
                                          rotation_matrix(a) @ rotation_matrix(b),
                                          atol=1e-12)
            numpy.testing.assert_allclose(multiply(a, conjugate(a)), (1, 0, 0, 0), atol=1e-12)

    def test_a_relative_pose_leads_back(self):
        random = numpy.random.default_rng(4)
        for turn, other in zip(random_turns(20, 5), random_turns(20, 6)):
            frame, pose = (random.normal(size=3), turn), (random.normal(size=3), other)
            back = world_pose(frame, relative_pose(frame, pose))
            numpy.testing.assert_allclose(back[0], pose[0], atol=1e-12)
            numpy.testing.assert_allclose(back[1], pose[1], atol=1e-12)

    def test_hulls_enclose_their_corners_and_have_the_right_volume(self):
        random = numpy.random.default_rng(7)
        shapes = [(motion_data.CORNERS, 0.6 * 0.6 * 0.66)]
        for _ in range(10):
            edges = random.uniform(0.5, 2, 3)
            box = edges * numpy.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)])
            shapes.append(
                (box @ rotation_matrix(random_turns(1, int(random.integers(99)))[0]).T, edges.prod()))
        for corners, volume in shapes:
            triangles = corners[hull_triangles(corners)]
            self.assertEqual(len(triangles), 12)
            middle = corners.mean(axis=0)
            found = 0
            for a, b, c in triangles:
                normal = numpy.cross(b - a, c - a)
                self.assertLess(((corners - a) @ normal).max(), 1e-9)  # outward
                found += normal @ (a - middle) / 6
            self.assertAlmostEqual(found, volume)

    def test_outlines_hold_their_shapes_and_not_much_more(self):
        with tempfile.TemporaryDirectory() as directory:
            geoms = load_motion(motion_data.write_motion(directory)).geoms[:-1]
        directions = random_turns(200, 9)[:, :3]
        directions /= numpy.linalg.norm(directions, axis=1)[:, None]
        for geom in geoms:
            points, radius_m = geom.outline()
            outline = (points @ directions.T).max(axis=0) + radius_m
            shape = support_m(geom, directions @ rotation_matrix(geom.orientation))
            shape = shape + directions @ geom.position
            self.assertLess((shape - outline).max(), 1e-9, geom.kind)
            self.assertLess((outline - shape).max(), 0.21 if geom.kind == "cylinder" else 1e-9, geom.kind)

    def test_points_in_general_position(self):
        corners = numpy.random.default_rng(8).normal(size=(20, 3))
        triangles = hull_triangles(corners)
        used = numpy.unique(triangles)
        self.assertEqual(len(triangles), 2 * len(used) - 4)  # Euler
        edges = {tuple(edge) for a, b, c in triangles for edge in ((a, b), (b, c), (c, a))}
        self.assertTrue(all((b, a) in edges for a, b in edges))  # closed, and all triangles turn the same way

    def test_planes_of_a_pit_meet_at_its_corners(self):
        with tempfile.TemporaryDirectory() as directory:
            motion = load_motion(motion_data.write_motion(directory, walls=True))
        planes = [geom for geom in motion.geoms if geom.kind == "plane"]
        polygons = plane_polygons(planes, numpy.array([-9, -9, -9.0]), numpy.array([9, 9, 3.0]))
        self.assertEqual(sorted(map(tuple,
                                    numpy.rint(polygons[0]).astype(int).tolist())), [(-2, -2, 0), (-2, 2, 0),
                                                                                     (2, -2, 0), (2, 2, 0)])
        for plane, polygon in zip(planes, polygons):
            self.assertEqual(len(polygon), 4)
            normal = rotation_matrix(plane.orientation)[:, 2]
            around = numpy.cross(polygon[1] - polygon[0], polygon[2] - polygon[1])
            self.assertGreater(around @ normal, 0)  # anticlockwise from outside
            numpy.testing.assert_allclose((polygon - plane.position) @ normal, 0, atol=1e-9)

    def test_a_plane_beside_the_box_is_not_seen(self):
        with tempfile.TemporaryDirectory() as directory:
            floor = load_motion(motion_data.write_motion(directory)).geoms[-1]
        self.assertEqual(len(plane_polygons([floor], numpy.ones(3), 2 * numpy.ones(3))[0]), 0)


if __name__ == "__main__":
    unittest.main()
