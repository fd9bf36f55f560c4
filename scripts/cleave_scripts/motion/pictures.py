"""Pictures of one step of a recorded run: bodies in their true shapes, the constraint graph, parts."""
import numpy

from cleave_scripts.motion.colours import EDGE, INNER_EDGE, NODE, PART_COLOURS
from cleave_scripts.motion.looks import Extent, body_reach, ground_polygons, look_of
from cleave_scripts.motion.povray_scene import (CONSTANT_LIGHT, GATHERED_LIGHT, Camera, graph, lights, polygon,
                                                render, rod, solid, sphere, vector)
from cleave_scripts.motion.shapes import world_pose

GROUND = (0.93, 0.93, 0.925)
WALL = (0.87, 0.88, 0.89)
TILES = "checker srgb <0.90, 0.91, 0.92> srgb <1, 1, 1> scale 2"  # metres
LEVEL = 0.999  # a plane whose normal rises this much is a floor


class Stage:
    """Camera, lights and ground for pictures of one run that shall match."""

    def __init__(self, motion, frames, size, gathered_light=True, eye=None, tiles=False):
        """frames: indices of the steps that are shown; size: pixels; eye: azimuth and elevation; tiles: of a
        lone floor, so that bodies in the distance do not seem to float."""
        self.motion = motion
        self.size = size
        self.aspect = size[0] / size[1]
        self.look = look_of(motion)
        self.floor = TILES if tiles else "srgb <1, 1, 1>"
        self.light = GATHERED_LIGHT if gathered_light else CONSTANT_LIGHT
        self.extent = Extent.of(motion, frames)
        self.camera = Camera.around(self.extent.points, self.extent.radii, *(eye or self.look.eye),
                                    self.aspect)

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
            return (f"plane {{ {vector(normal)}, {normal @ floor.position:.7g} "
                    f"pigment {{ {self.floor} }} finish {{ Floor }} }}\n")
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


def picture_of_bodies(stage, frame, colour=None):
    """In the colour of their material, or in those of their parts: `colour` as of part_colouring."""
    if colour is None:
        return stage.render(stage.bodies(frame, tint_of(stage.motion, stage.look)))
    return stage.render(stage.bodies(frame, lambda body: PART_COLOURS[colour[body]]))


def picture_with_graph(stage, frame, index):
    """The bodies of a measured step with its constraint graph over them."""
    return stage.render(
        stage.bodies(frame, tint_of(stage.motion, stage.look)) +
        stage.graph(frame, stage.motion.measured.edges(index)))


def picture_of_parts(stage, frame, index, combination, colour):
    """A ball for every body, coloured by part; constraints between parts red, inside parts grey."""
    motion = stage.motion
    part = motion.measured["part"][index, combination]
    centres = motion.position[frame].astype(float)
    reach = body_reach(motion)
    ball_m = 0.6 * reach
    text = "".join(
        sphere(centres[body], ball_m[body], PART_COLOURS[colour[body]]) for body in range(motion.bodies))
    stick_m = 0.07 * float(numpy.median(reach))
    cut = []
    for a, b in motion.measured.edges(index):
        if part[a] == part[b]:
            text += rod(centres[a], centres[b], 0.8 * stick_m, INNER_EDGE)
        else:
            cut.append((a, b))
    # Grey walls would only dull the colours.
    return stage.render(text + graph(stage.camera, centres, cut, (stick_m, EDGE)), walls=False)
