"""How recorded scenes are shown, in figures and in the viewer: view, material, size of nodes, ground."""
import dataclasses

import numpy

from motion_shapes import plane_polygons, rotation_matrix


@dataclasses.dataclass(frozen=True)
class Look:
    """How a scene is shown: where the eye stands (degrees), what share of the body positions must be in view,
    and what the bodies are made of."""

    azimuth: float = -58
    elevation: float = 32
    keep: float = 1.0
    tint: tuple = (0.68, 0.68, 0.68)
    step: int = None  # that shows the scene best; the last measured one where not given


LOOKS = {
    "chain_drop": Look(elevation=56, tint=(0.62, 0.66, 0.71)),
    "log_tower": Look(azimuth=-35, elevation=20, keep=0.96, tint=(0.80, 0.62, 0.42), step=139),
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


def inliers(points, keep):
    """Which points are among this share of those nearest to the middle."""
    distance = numpy.linalg.norm(points - numpy.median(points, axis=0), axis=1)
    return distance <= numpy.quantile(distance, keep)


@dataclasses.dataclass
class Extent:
    """The space that the shown bodies fill in some frames; bodies that flew away do not count."""

    points: numpy.ndarray  # (p, 3) positions of bodies
    radii: numpy.ndarray  # (p) how far these reach
    wall_top_m: float

    @staticmethod
    def of(motion, frames):
        keep, reach = look_of(motion).keep, body_reach(motion)
        points = motion.position[frames].reshape(-1, 3).astype(float)
        inside = inliers(points, keep)
        # Walls without end would hide what falls into the pit; they end where the bodies lie at last.
        last = motion.position[frames[-1]]
        wall_top_m = float((last[:, 2] + reach)[inliers(last, keep)].max())
        return Extent(points[inside], numpy.tile(reach, len(frames))[inside], wall_top_m)

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
