"""How recorded scenes are shown, in figures and in the viewer: view, material, size of nodes, ground."""
import dataclasses

import numpy

from cleave_scripts.motion.shapes import plane_polygons, rotation_matrix


@dataclasses.dataclass(frozen=True)
class Look:
    """How a scene is shown: where the eye stands (degrees), and what the bodies are made of."""

    eye: tuple = (-58, 32)  # azimuth, elevation
    tint: tuple = (0.68, 0.68, 0.68)
    step: int = None  # that shows the scene best; the last measured one where not given
    run_eye: tuple = None  # for film strip and viewer, which show the whole run; the same where not given


LOOKS = {
    "chain_drop": Look(eye=(-58, 56), tint=(0.62, 0.66, 0.71)),
    "log_tower": Look(eye=(-140, 20), tint=(0.80, 0.62, 0.42), step=139, run_eye=(-155, 24)),
    "rock_pile": Look(tint=(0.70, 0.67, 0.62)),
    "large_rock_pile": Look(tint=(0.70, 0.67, 0.62)),
}


def look_of(motion):
    return LOOKS.get(motion.scene, Look())


def body_reach(motion):
    reach = numpy.zeros(motion.bodies)
    for geom in motion.geoms:
        if geom.body >= 0:
            reach[geom.body] = max(reach[geom.body], geom.reach_m())
    return reach


def body_thickness(motion):
    """Half the least extent of each body's thickest shape."""
    thickness = numpy.zeros(motion.bodies)
    for geom in motion.geoms:
        if geom.body >= 0:
            thickness[geom.body] = max(thickness[geom.body], geom.thickness_m())
    return thickness


def body_outlines(motion, frames):
    """(points, radii) of balls that just hold all bodies in some frames."""
    outlines = [(geom.body, *geom.outline()) for geom in motion.geoms if geom.body >= 0]
    points, radii = [], []
    for frame in frames:
        position = motion.position[frame].astype(float)
        turn = [rotation_matrix(orientation) for orientation in motion.orientation[frame]]
        for body, own, radius_m in outlines:
            points.append(position[body] + own @ turn[body].T)
            radii.append(numpy.full(len(own), radius_m))
    return numpy.concatenate(points), numpy.concatenate(radii)


@dataclasses.dataclass
class Extent:
    """The space that the bodies fill in some frames."""

    points: numpy.ndarray  # (p, 3) middles of balls that hold the bodies
    radii: numpy.ndarray  # (p) of these
    wall_top_m: float

    @staticmethod
    def of(motion, frames):
        points, radii = body_outlines(motion, frames)
        # Walls without end would hide what falls into the pit; they end where the bodies lie at last.
        last, last_radii = body_outlines(motion, frames[-1:])
        return Extent(points, radii, float((last[:, 2] + last_radii).max()))

    @property
    def low(self):
        return (self.points - self.radii[:, None]).min(axis=0)

    @property
    def high(self):
        return (self.points + self.radii[:, None]).max(axis=0)

    @property
    def diagonal_m(self):
        return float(numpy.linalg.norm(self.high - self.low))

    def node_radius_m(self, motion):
        """Of the graph's balls: small beside the bodies, yet to be seen."""
        return min(0.01 * self.diagonal_m, float(numpy.median(body_thickness(motion))))


def ground_polygons(motion, extent):
    """(plane, polygon, outward normal) of all static planes in view, cut off above the bodies at rest."""
    planes = [geom for geom in motion.geoms if geom.kind == "plane"]
    aside = numpy.array([2 * extent.diagonal_m] * 2 + [0])
    low, high = extent.low - aside - [0, 0, 1], extent.high + aside
    high[2] = extent.wall_top_m
    found = zip(planes, plane_polygons(planes, low, high))
    return [(plane, corners, rotation_matrix(plane.orientation)[:, 2])
            for plane, corners in found
            if len(corners) >= 3]
