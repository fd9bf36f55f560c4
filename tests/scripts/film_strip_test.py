"""The film strip: nothing leaves its pictures, and parts keep their colours from one to the next."""
import pathlib
import tempfile
import unittest

import motion_data
import numpy

from cleave_scripts.motion import film_strip
from cleave_scripts.motion.recording import load_motion
from cleave_scripts.motion.shapes import rotation_matrix, world_pose

EVERY = 5
WIDTH = 400
ROUNDING = 1e-6
SCENES = ("log_tower", "rock_pile")  # of which one has an eye of its own for the run


def scatter(file):
    """Bodies fly apart, the last one far away."""
    position = motion_data.positions()
    position[:, :, :2] *= numpy.linspace(1, 4, motion_data.STEPS)[:, None, None]
    position[:, -1, 0] += numpy.linspace(0, 30, motion_data.STEPS)
    del file["position"]
    file["position"] = position


def corners_m(motion, frame):
    """Corners of the boxes that hold the geoms, in their own frames."""
    corners = []
    for geom in motion.geoms:
        if geom.body >= 0:
            pose = (motion.position[frame][geom.body], motion.orientation[frame][geom.body])
            place, turn = world_pose(pose, (geom.position, geom.orientation))
            corners.append(place + boxed(geom) @ rotation_matrix(turn).T)
    return numpy.concatenate(corners)


def boxed(geom):
    if geom.kind == "convex":
        return geom.corners
    unit = numpy.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
    if geom.kind == "box":
        return unit * geom.size / 2
    # Round ones: points on their surfaces.
    around = numpy.linspace(0, 2 * numpy.pi, 24, endpoint=False)
    ring = numpy.stack([numpy.cos(around), numpy.sin(around), 0 * around], -1) * geom.size[0]
    half = 0 if geom.kind == "sphere" else geom.size[1] / 2
    cap = geom.size[0] * (geom.kind != "cylinder")
    top = numpy.array((0, 0, half))
    poles = [(0, 0, half + cap), (0, 0, -half - cap)]
    return numpy.concatenate([ring + top, ring - top, poles])


def in_picture(stage, points):
    """(p, 2) places in a picture, -1 to 1 from edge to edge: what POV-Ray's camera does."""
    camera = stage.camera
    right = numpy.cross([0, 0, 1], camera.back)
    right /= numpy.linalg.norm(right)
    up = numpy.cross(camera.back, right)
    relative = points - camera.eye
    depth = -(relative @ camera.back)
    half = numpy.tan(numpy.radians(26) / 2)
    return numpy.stack([relative @ right / half, relative @ up / half * stage.aspect], -1) / depth[:, None]


class FilmStripTest(unittest.TestCase):

    def motion(self, scene, change=None):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        return load_motion(motion_data.write_motion(pathlib.Path(scratch.name), scene=scene, change=change))

    def test_all_bodies_are_within_every_picture_and_fill_the_strip(self):
        for scene in SCENES:
            for change in (None, scatter):
                motion = self.motion(scene, change)
                frames = film_strip.frames_of(motion, EVERY)
                stage = film_strip.stage_of(motion, frames, WIDTH)
                most = 0
                for frame in frames:
                    place = abs(in_picture(stage, corners_m(motion, frame)))
                    self.assertLess(place.max(), 1 + ROUNDING, (scene, frame))
                    most = max(most, place.max())
                self.assertGreater(most, 0.85, scene)

    def test_parts_keep_their_colours_from_picture_to_picture(self):
        motion = self.motion("log_tower")
        part = motion.measured["part"]
        parts = numpy.arange(motion_data.BODIES) // 2
        for index in range(len(part)):
            part[index, :] = numpy.random.default_rng(index).permutation(9)[parts]
        frames = film_strip.frames_of(motion, EVERY)
        colours = film_strip.colours_of(motion, frames, 0)
        self.assertIsNone(colours[0])  # before the first split
        for colour in colours[1:]:
            numpy.testing.assert_array_equal(colour, colours[1])


if __name__ == "__main__":
    unittest.main()
