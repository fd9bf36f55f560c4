"""Pictures of bodies and graphs by POV-Ray: lit, with shadows, sorted by depth, the same on every run."""
import dataclasses
import pathlib
import subprocess
import tempfile

import matplotlib.image
import numpy

from cleave_scripts.motion.colours import EDGE_CASING, EDGE_CASING_SCALE
from cleave_scripts.motion.shapes import hull_triangles, rotation_matrix
from cleave_scripts.results.errors import ResultError

FIELD_OF_VIEW = numpy.radians(26)  # across the picture
# Graphs are drawn as they are, but this much nearer to the eye than anything else: in front of the bodies,
# with unchanged perspective.
OVERLAY_SCALE = 1e-3
CASING_SCALE = 1e-2  # of the casings of lines: behind all of these, so that crossings stay whole
# Light that comes from the sky and from other surfaces: gathered in large pictures, a constant in small ones.
GATHERED_LIGHT = """#version 3.7;
global_settings {
  assumed_gamma 1.0 max_trace_level 8
  radiosity { count 40 error_bound 1.2 nearest_count 8 recursion_limit 1 low_error_factor 0.7
              gray_threshold 0.5 minimum_reuse 0.02 pretrace_start 0.08 pretrace_end 0.02 brightness 0.9 }
}
background { srgb <1, 1, 1> }
#default { finish { ambient 0 diffuse 0.8 specular 0.1 roughness 0.08 } }
#declare Floor = finish { diffuse 0.82 emission 0.18 specular 0 }
"""
CONSTANT_LIGHT = """#version 3.7;
global_settings { assumed_gamma 1.0 max_trace_level 8 }
background { srgb <1, 1, 1> }
#default { finish { ambient 0 emission 0.32 diffuse 0.9 specular 0.1 roughness 0.08 } }
#declare Floor = finish { diffuse 0.82 emission 0.6 specular 0 }
"""


@dataclasses.dataclass
class Camera:
    """A view that just holds some points."""

    eye: numpy.ndarray
    target: numpy.ndarray
    back: numpy.ndarray  # unit, from the target to the eye

    @staticmethod
    def around(points, radii, azimuth, elevation, aspect, margin=1.04):
        """azimuth, elevation in degrees: where the eye stands as seen from the points; aspect: width/height.

        A point at (x, y, z) in the camera's frame, eye at distance D, is inside while |x - c| <= t (D - z),
        so the least distance for both edges of the picture is known without any search.
        """
        back = direction_to_eye(azimuth, elevation)
        right = numpy.array([-numpy.sin(numpy.radians(azimuth)), numpy.cos(numpy.radians(azimuth)), 0])
        up = numpy.cross(back, right)
        depth = points @ back
        tangent = numpy.tan(FIELD_OF_VIEW / 2) / margin
        distance, middle = 0, []
        for axis, slope in ((right, tangent), (up, tangent / aspect)):
            most = (points @ axis + radii + slope * depth).max()
            least = (-(points @ axis) + radii + slope * depth).max()
            middle.append((most - least) / 2)
            distance = max(distance, (most + least) / (2 * slope))
        target = middle[0] * right + middle[1] * up
        return Camera(target + distance * back, target, back)

    def povray(self, aspect):
        return (f"camera {{ location {vector(self.eye)} sky z right -{aspect:.6g}*x up y "
                f"look_at {vector(self.target)} angle {numpy.degrees(FIELD_OF_VIEW):.6g} }}\n")


def direction_to_eye(azimuth, elevation):
    azimuth, elevation = numpy.radians([azimuth, elevation])
    return numpy.array([
        numpy.cos(elevation) * numpy.cos(azimuth),
        numpy.cos(elevation) * numpy.sin(azimuth),
        numpy.sin(elevation)
    ])


def vector(values):
    return "<" + ", ".join(f"{value:.7g}" for value in values) + ">"


def pigment(colour):
    return f"pigment {{ srgb {vector(colour)} }}"


def lights(camera, size_m):
    """A soft key light over the viewer's left shoulder and a weak one without shadow."""
    back = camera.back
    right = numpy.cross([0, 0, 1], back)
    right /= numpy.linalg.norm(right)
    key = camera.target + size_m * (1.5 * back - 1.2 * right + [0, 0, 3.2])
    area = 0.9 * size_m
    fill = camera.target + size_m * (3 * back + 2.5 * right + [0, 0, 0.5])
    return (f"light_source {{ {vector(key)} rgb 0.62 area_light {vector(area * right)} "
            f"{vector(area * numpy.cross(back, right))} 5 5 adaptive 1 circular orient }}\n"
            f"light_source {{ {vector(fill)} rgb 0.12 shadowless }}\n")


def sphere(centre, radius, colour, extra=""):
    return f"sphere {{ {vector(centre)}, {radius:.7g} {pigment(colour)} {extra}}}\n"


def rod(start, end, radius, colour, extra=""):
    if numpy.linalg.norm(end - start) < 1e-9:
        return ""
    return f"cylinder {{ {vector(start)}, {vector(end)}, {radius:.7g} {pigment(colour)} {extra}}}\n"


def _box(size):
    return f"box {{ {vector(-size / 2)}, {vector(size / 2)}"


def _capsule(size):
    radius, half = size[0], size[1] / 2
    return (f"merge {{ cylinder {{ <0,0,{-half:.7g}>, <0,0,{half:.7g}>, {radius:.7g} }} "
            f"sphere {{ <0,0,{-half:.7g}>, {radius:.7g} }} sphere {{ <0,0,{half:.7g}>, {radius:.7g} }}")


def _cylinder(size):
    return f"cylinder {{ <0,0,{-size[1] / 2:.7g}>, <0,0,{size[1] / 2:.7g}>, {size[0]:.7g}"


def _convex(corners):
    triangles = hull_triangles(corners)
    points = ", ".join(vector(corner) for corner in corners)
    faces = ", ".join(vector(triangle) for triangle in triangles)
    return (f"mesh2 {{ vertex_vectors {{ {len(corners)}, {points} }} "
            f"face_indices {{ {len(triangles)}, {faces} }}")


def solid(geom, position, orientation, colour):
    """A geom at a pose in the world."""
    own = {
        "box": lambda: _box(geom.size),
        "sphere": lambda: f"sphere {{ <0,0,0>, {geom.size[0]:.7g}",
        "capsule": lambda: _capsule(geom.size),
        "cylinder": lambda: _cylinder(geom.size),
        "convex": lambda: _convex(geom.corners),
    }[geom.kind]()
    # POV-Ray multiplies rows, so the matrix stands column by column.
    rotation = rotation_matrix(orientation).T.ravel()
    matrix = ", ".join(f"{value:.7g}" for value in [*rotation, *position])
    return f"{own} {pigment(colour)} matrix <{matrix}> }}\n"


def polygon(corners, colour):
    if len(corners) < 3:
        return ""
    ring = [*corners, corners[0]]
    return (f"polygon {{ {len(ring)}, {', '.join(map(vector, ring))} {pigment(colour)} "
            "finish { specular 0 } no_shadow }\n")


def graph(camera, centres, edges, stick, ball=None):
    """Sticks with a casing between centres and balls at all of them; each (radius, colour)."""
    radius_m, colour = stick
    casing = _overlay(camera, CASING_SCALE, centres, edges, EDGE_CASING_SCALE * radius_m, EDGE_CASING,
                      "finish { ambient 0 emission 1 diffuse 0 specular 0 } no_radiosity ")
    extra = "finish { ambient 0.0 emission 0.28 diffuse 0.6 specular 0.25 } "
    lines = _overlay(camera, OVERLAY_SCALE, centres, edges, radius_m, colour, extra)
    near = camera.eye + OVERLAY_SCALE * (centres - camera.eye)
    balls = (sphere(centre, OVERLAY_SCALE * ball[0], ball[1], "no_shadow " + extra) for centre in near)
    return casing + lines + "".join(balls if ball else ())


def _overlay(camera, scale, centres, edges, radius_m, colour, extra):
    near = camera.eye + scale * (centres - camera.eye)
    return "".join(
        rod(near[a], near[b], scale * radius_m, colour, "no_shadow " + extra) for a, b in edges)


def render(text, width, height):
    """The picture as (height, width, 3) in [0, 1].

    By one thread: with several, light is gathered in an order that changes from run to run. Whoever wants
    many pictures makes them side by side.
    """
    with tempfile.TemporaryDirectory() as directory:
        directory = pathlib.Path(directory)
        (directory / "scene.pov").write_text(text, encoding="ascii")
        command = [
            "povray", "+Iscene.pov", "+Opicture.png", f"+W{width}", f"+H{height}", "+FN", "-D", "-V", "-GD",
            "-GR", "-GS", "-GW", "+A0.15", "+AM2", "+R3", "-J", "+WT1"
        ]
        try:
            result = subprocess.run(command, cwd=directory, capture_output=True, text=True, check=False)
        except FileNotFoundError:
            raise ResultError("povray is not installed; scripts/setup installs it") from None
        picture = directory / "picture.png"
        if result.returncode != 0 or not picture.exists():
            lines = [line for line in result.stderr.splitlines() if "rror" in line] or ["no picture"]
            raise ResultError(f"povray failed: {lines[0].strip()}")
        return matplotlib.image.imread(picture)[..., :3]
