"""Pictures of one step of a recorded run: bodies in their true shapes, the constraint graph, parts."""
import numpy

from motion_colours import EDGE, NODE, part_colour
from motion_looks import Extent, body_reach, ground_polygons, look_of
from motion_shapes import world_pose
from povray_scene import (CONSTANT_LIGHT, GATHERED_LIGHT, Camera, graph, lights, polygon, render, rod, solid,
                          sphere, vector)

GROUND = (0.93, 0.93, 0.925)
WALL = (0.87, 0.88, 0.89)
LEVEL = 0.999  # a plane whose normal rises this much is a floor
INNER_EDGE = (0.45, 0.47, 0.50)  # inside a part
CUT_EDGE = (0.84, 0.05, 0.10)


class Stage:
    """Camera, lights and ground for pictures of one run that shall match."""

    def __init__(self, motion, frames, size, gathered_light=True):
        """frames: indices of the steps that are shown; size: pixels."""
        self.motion = motion
        self.size = size
        self.aspect = size[0] / size[1]
        self.look = look_of(motion)
        self.light = GATHERED_LIGHT if gathered_light else CONSTANT_LIGHT
        self.extent = Extent.of(motion, frames)
        self.camera = Camera.around(self.extent.points, self.extent.radii, self.look.azimuth,
                                    self.look.elevation, self.aspect)

    def render(self, content, walls=True):
        return render(
            self.light + self.camera.povray(self.aspect) + lights(self.camera, self.extent.diagonal_m) +
            self._ground(walls) + content, *self.size)

    def _ground(self, walls):
        """A lone floor goes on for ever; of a pit only what faces the camera is drawn."""
        ground = [
            entry for entry in ground_polygons(self.motion, self.extent) if walls or entry[2][2] > LEVEL
        ]
        if len(ground) == 1:
            floor, _, normal = ground[0]
            return (f"plane {{ {vector(normal)}, {normal @ floor.position:.7g} pigment {{ srgb <1,1,1> }} "
                    "finish { Floor } }\n")
        return "".join(
            polygon(corners, GROUND if normal[2] > LEVEL else WALL)
            for _, corners, normal in ground
            if normal @ (self.camera.eye - corners[0]) > 0)

    def bodies(self, frame, colour_of_body):
        text = ""
        for geom in self.motion.geoms:
            if geom.body >= 0:
                body = (self.motion.position[frame][geom.body], self.motion.orientation[frame][geom.body])
                text += solid(geom, *world_pose(body, (geom.position, geom.orientation)),
                              colour_of_body(geom.body))
        return text

    def graph(self, frame, edges):
        """The constraint graph over the picture: nodes blue, edges red, thinner where there are many."""
        node_m = self.extent.node_radius_m(self.motion)
        stick_m = 0.3 * node_m * min(1, 1.5 * self.motion.bodies / max(len(edges), 1))
        centres = self.motion.position[frame].astype(float)
        return graph(self.camera, centres, edges, (stick_m, EDGE), (node_m, NODE))


def tint_of(motion, look):
    """Colours of bodies of one material, a little lighter and darker from body to body."""
    shade = numpy.random.default_rng(0).uniform(0.88, 1.1, motion.bodies)
    return lambda body: numpy.clip(numpy.array(look.tint) * shade[body], 0, 1)


def picture_of_bodies(stage, frame, combination=None):
    """In the colour of their material, or of the parts of a combination where the step has been split."""
    motion = stage.motion
    index = None if combination is None else motion.measured_index(motion.step[frame])
    if index is None:
        return stage.render(stage.bodies(frame, tint_of(motion, stage.look)))
    part = motion.measured["part"][index, combination]
    return stage.render(stage.bodies(frame, lambda body: part_colour(part[body])))


def picture_with_graph(stage, frame, index):
    """The bodies of a measured step with its constraint graph over them."""
    return stage.render(
        stage.bodies(frame, tint_of(stage.motion, stage.look)) +
        stage.graph(frame, stage.motion.measured.edges(index)))


def picture_of_parts(stage, frame, index, combination):
    """A ball for every body, coloured by part; constraints between parts red, inside parts grey."""
    motion = stage.motion
    part = motion.measured["part"][index, combination]
    centres = motion.position[frame].astype(float)
    reach = body_reach(motion)
    ball_m = 0.6 * reach
    text = "".join(
        sphere(centres[body], ball_m[body], part_colour(part[body])) for body in range(motion.bodies))
    stick_m = 0.065 * float(numpy.median(reach))
    cut = []
    for a, b in motion.measured.edges(index):
        if part[a] == part[b]:
            text += rod(centres[a], centres[b], 0.8 * stick_m, INNER_EDGE)
        else:
            cut.append((a, b))
    # Grey walls would only dull the colours.
    return stage.render(text + graph(stage.camera, centres, cut, (stick_m, CUT_EDGE)), walls=False)
