"""Geometry of recorded bodies: quaternions (w x y z), convex hulls, and what is seen of static planes."""
import dataclasses
import itertools

import numpy


@dataclasses.dataclass
class Geom:
    """One shape, placed relative to its body, or in the world where body is -1.

    size by kind, in metres: box edges; sphere radius; capsule and cylinder radius and length along z (of a
    capsule without its caps); none for convex (corners) and plane (z is the outward normal).
    """

    body: int
    kind: str
    size: numpy.ndarray
    position: numpy.ndarray
    orientation: numpy.ndarray
    corners: numpy.ndarray

    def outline(self):
        """Points of the body's frame and a radius: balls of that radius at the points just hold the shape."""
        if self.kind == "convex":
            own, radius_m = self.corners, 0.0
        elif self.kind == "box":
            own, radius_m = numpy.array(list(itertools.product((-0.5, 0.5), repeat=3))) * self.size, 0.0
        elif self.kind == "sphere":
            own, radius_m = numpy.zeros((1, 3)), self.size[0]
        else:
            own, radius_m = numpy.array([[0, 0, -0.5], [0, 0, 0.5]]) * self.size[1], self.size[0]
        return self.position + own @ rotation_matrix(self.orientation).T, float(radius_m)

    def reach_m(self):
        """No point of the shape is farther from the origin of its body."""
        own = {
            "box": lambda: numpy.linalg.norm(self.size) / 2,
            "sphere": lambda: self.size[0],
            "capsule": lambda: self.size[1] / 2 + self.size[0],
            "cylinder": lambda: numpy.hypot(self.size[1] / 2, self.size[0]),
            "convex": lambda: numpy.linalg.norm(self.corners, axis=1).max(),
        }[self.kind]()
        return float(numpy.linalg.norm(self.position) + own)

    def thickness_m(self):
        """Half the least extent."""
        if self.kind == "convex":
            return float(numpy.ptp(self.corners, axis=0).min() / 2)
        return float(self.size.min() / 2 if self.kind == "box" else self.size[0])


def multiply(a, b):
    """The rotation b, then a. Works on arrays of quaternions too."""
    w, x, y, z = numpy.moveaxis(numpy.asarray(a, float), -1, 0)
    p, q, r, s = numpy.moveaxis(numpy.asarray(b, float), -1, 0)
    return numpy.stack([
        w * p - x * q - y * r - z * s, w * q + x * p + y * s - z * r, w * r - x * s + y * p + z * q,
        w * s + x * r - y * q + z * p
    ], -1)


def conjugate(q):
    return numpy.asarray(q) * (1, -1, -1, -1)


def rotation_matrix(q):
    w, x, y, z = numpy.asarray(q, float) / numpy.linalg.norm(q)
    return numpy.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def relative_pose(frame, pose):
    """A world pose as seen from a frame; each a (position, orientation)."""
    position = rotation_matrix(frame[1]).T @ (numpy.asarray(pose[0], float) - frame[0])
    return position, multiply(conjugate(frame[1]), pose[1])


def world_pose(frame, pose):
    """The inverse of relative_pose."""
    return frame[0] + rotation_matrix(frame[1]) @ pose[0], multiply(frame[1], pose[1])


def hull_triangles(corners):
    """Triangles (t, 3 corner indices), anticlockwise from outside, of the hull of a few corners.

    Every triple whose plane has all corners on one side lies in a face; a face's corners are sorted round
    its middle. The time goes with the fourth power of the number of corners, which are 8 in our scenes.
    """
    corners = numpy.asarray(corners, float)
    tolerance = 1e-9 * numpy.ptp(corners, axis=0).max()
    faces = {}
    for triple in itertools.combinations(range(len(corners)), 3):
        a, b, c = corners[list(triple)]
        normal = numpy.cross(b - a, c - a)
        length = numpy.linalg.norm(normal)
        if length <= tolerance**2:
            continue
        normal /= length
        height = (corners - a) @ normal
        if height.max() > tolerance and height.min() < -tolerance:
            continue
        on_face = numpy.flatnonzero(abs(height) <= tolerance)
        faces[tuple(on_face)] = normal if height.max() <= tolerance else -normal
    return numpy.array([triangle for face in faces.items() for triangle in _fan(corners, *face)])


def _fan(corners, face, normal):
    around = corners[list(face)] - corners[list(face)].mean(axis=0)
    first = around[0] / numpy.linalg.norm(around[0])
    angles = numpy.arctan2(around @ numpy.cross(normal, first), around @ first)
    ring = [face[i] for i in numpy.argsort(angles)]
    return [(ring[0], ring[i], ring[i + 1]) for i in range(1, len(ring) - 1)]


def plane_polygons(planes, low, high):
    """What is seen of static planes inside a box: for each a polygon (k, 3), anticlockwise from outside.

    A plane is cut off where it enters the solid of another one, so a pit gets a floor and walls that end at
    its corners. A plane that does not meet the box has an empty polygon.
    """
    frames = [rotation_matrix(plane.orientation) for plane in planes]
    sides = [(frame[:, 2], frame[:, 2] @ plane.position) for frame, plane in zip(frames, planes)]
    box = [(numpy.eye(3)[k], low[k]) for k in range(3)] + [(-numpy.eye(3)[k], -high[k]) for k in range(3)]
    middle, far = (low + high) / 2, 2 * numpy.linalg.norm(high - low)
    polygons = []
    for i, (frame, (normal, offset)) in enumerate(zip(frames, sides)):
        foot = middle - (normal @ middle - offset) * normal
        polygon = [
            foot + far * (x * frame[:, 0] + y * frame[:, 1]) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))
        ]
        for j, half_space in enumerate(sides + box):
            if j != i:
                polygon = _clip(polygon, *half_space)
        polygons.append(numpy.array(polygon).reshape(-1, 3))
    return polygons


def _clip(polygon, normal, offset):
    """The part of a polygon with normal . x >= offset."""
    kept = []
    for a, b in zip(polygon, polygon[1:] + polygon[:1]):
        height_a, height_b = normal @ a - offset, normal @ b - offset
        if height_a >= 0:
            kept.append(a)
        if (height_a >= 0) != (height_b >= 0):
            kept.append(a + (b - a) * height_a / (height_a - height_b))
    return kept
