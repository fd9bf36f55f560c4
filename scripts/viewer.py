"""The viewer: an HTML fragment that replays recorded runs in WebGL, with no file or network beside it.

    viewer_section(directory)   the fragment, or a note where no motion was recorded
    viewer_page(directory)      a page of its own

The sources of the page are in scripts/viewer/. `npm ci` brings three.js and the bundler esbuild, in the
versions of package-lock.json, when they are not there yet.
"""
import base64
import gzip
import html
import json
import pathlib
import string
import subprocess
import tempfile

import matplotlib
import numpy

from cleave_results import ResultError
from motion import NO_PART, load_motions
from motion_colours import EDGE, EDGE_CASING, EDGE_CASING_SCALE, INNER_EDGE, NODE, PART_COLOURS
from motion_looks import Extent, ground_polygons, look_of
from motion_shapes import hull_triangles
from part_colouring import colour_sequence
from povray_scene import direction_to_eye

SOURCES = pathlib.Path(__file__).resolve().parent / "viewer"
PAGE_BYTES = 30e6  # recordings are thinned to about this much
FIELD_OF_VIEW = 19  # degrees, from the lower to the upper edge
NO_MOTION = ("<p class=\"cleave-message\">No motion recorded: there is no motion.h5. "
             "<code>cleave run --record-motion</code> writes one.</p>\n")


def viewer_section(directory, autofocus=False, page_bytes=PAGE_BYTES):
    """All recordings in a directory or below, one at a time."""
    motions = load_motions(directory)
    if not motions:
        return NO_MOTION
    recordings = "\n".join(_recording_script(motion, page_bytes / len(motions)) for motion in motions)
    template = string.Template((SOURCES / "viewer.html").read_text(encoding="utf-8"))
    return template.substitute(css=(SOURCES / "viewer.css").read_text(encoding="utf-8"),
                               autofocus=" autofocus" if autofocus else "",
                               recordings=recordings,
                               script=build_script())


def viewer_page(directory, **options):
    section = viewer_section(directory, autofocus=True, **options)
    return ("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
            "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
            "<title>cleave: recorded motion</title>\n"
            f"<link rel=\"icon\" href=\"data:,\">\n</head>\n<body>\n{section}</body>\n</html>\n")


def build_script():
    """The page's program with three.js in it, as text that may stand in a script element."""
    if not (SOURCES / "node_modules" / ".bin" / "esbuild").exists():
        _run(["npm", "ci", "--silent"], "installing three.js and esbuild from npm")
    with tempfile.TemporaryDirectory() as directory:
        bundle = pathlib.Path(directory) / "viewer.js"
        _run([
            "node_modules/.bin/esbuild", "source/main.js", "--bundle", "--minify", "--format=iife",
            "--target=es2022", "--log-level=error", f"--outfile={bundle}"
        ], "bundling the viewer")
        return bundle.read_text(encoding="utf-8")


def _run(command, what):
    try:
        result = subprocess.run(command, cwd=SOURCES, capture_output=True, text=True, check=False)
    except FileNotFoundError:
        raise ResultError(f"{what}: {command[0]} is not installed; scripts/setup installs it") from None
    if result.returncode != 0:
        text = (result.stderr or result.stdout).strip().splitlines() or ["no message"]
        raise ResultError(f"{what} failed: {text[0]}")


def _recording_script(motion, most_bytes):
    """Thins until it fits: every k-th measured step, and every k-th step besides."""
    stride, script = 1, pack(motion, 1)
    while len(script) > most_bytes and stride < len(motion.step):
        stride = max(stride + 1, int(numpy.ceil(stride * len(script) / most_bytes)))
        script = pack(motion, stride)
    name = html.escape(_recording_name(motion))
    return f'<script type="application/json" class="cleave-recording" data-name="{name}">{script}</script>'


def _recording_name(motion):
    text = f"{motion.scene}, {motion.bodies} bodies, seed {motion.attributes['seed']}"
    directory = motion.path.resolve().parent.name
    return text if directory == motion.scene else f"{directory}: {text}"


def pack(motion, stride):
    """A recording as JSON: a description and all numbers, compressed. See viewer/source/recording.js."""
    measured = motion.measured
    kept = numpy.arange(len(measured.step))[::-1][::stride][::-1]  # the last one always
    frames = numpy.unique(
        numpy.concatenate(
            [numpy.arange(len(motion.step))[::stride],
             numpy.searchsorted(motion.step, measured.step[kept])]))
    origin, unit, position = _quantized_positions(motion.position[frames])
    parts, no_part = _part_codes(measured["part"][kept])
    edges = [measured.edges(index) for index in kept]
    part_colour, island_colour = _colours(motion, kept, edges)
    residual_range, residual = _magnitude_codes(measured["residual_m_per_s"][kept])
    impulse_range, impulse = _magnitude_codes(measured["largest_impulse_n_s"][kept])
    arrays = {
        "step": motion.step[frames].astype("<i4"),
        "position": position,
        "orientation": _quantized_orientations(motion.orientation[frames]),
        "measuredStep": measured.step[kept].astype("<i4"),
        "keptOfAll": kept.astype("<i4"),
        "island": measured.island[kept].astype("<u2"),
        "firstEdge": numpy.concatenate([[0], numpy.cumsum([len(each) for each in edges])]).astype("<i4"),
        "edge": numpy.concatenate([*edges, numpy.zeros((0, 2))]).astype("<u2"),
        "part": parts,
        "partColour": part_colour,
        "islandColour": island_colour,
        "residual": residual,
        "impulse": impulse,
        "curveStep": measured.step.astype("<i4"),
        "tSMs": measured["t_s_ms"].astype("<f4"),
        "interfaceRows": measured["interface_rows"].astype("<i4"),
        "ok": measured["ok"].astype("u1"),
    }
    described, data = _join(arrays)
    extent = Extent.of(motion, _settling_frames(motion))
    description = {
        "arrays": described,
        "bodies": motion.bodies,
        "planned_steps": int(motion.attributes["steps"]),
        "h_s": float(motion.attributes["h_s"]),
        "combinations": [_combination_name(names) for names in motion.combinations],
        "mass_kg": motion.mass_kg.tolist(),
        "origin_m": origin.tolist(),
        "unit_m": unit,
        "no_part": no_part,
        "ranges": {
            "residual": residual_range,
            "impulse": impulse_range
        },
        "geoms": [_geom(geom) for geom in motion.geoms if geom.body >= 0],
        "ground": _ground(motion, extent),
        "view": _view(look_of(motion), extent),
        "node_radius_m": extent.node_radius_m(motion),
        "part_colours": PART_COLOURS,
        "plain_colour": look_of(motion).tint,
        "node_colour": NODE,
        "edge_colour": EDGE,
        "edge_casing_colour": EDGE_CASING,
        "edge_casing_scale": EDGE_CASING_SCALE,
        "inner_edge_colour": INNER_EDGE,
        **_ramp(),
        "note": _note(motion, stride, unit),
    }
    packed = {"description": description, "data": base64.b64encode(gzip.compress(data, 6, mtime=0)).decode()}
    return json.dumps(packed).replace("</", "<\\/")


def _settling_frames(motion):
    """Some frames whose bodies set the size of ground and shadows; in the first ones they may be far above."""
    last = len(motion.step) - 1
    return numpy.linspace(last // 6, last, 12).astype(int)


def _combination_name(names):
    partitioner, refiner, solver = names
    return solver if partitioner == "-" else f"{partitioner} + {refiner}, {solver}"


def _join(arrays):
    """Arrays end to end, each at a multiple of its item size because the widest come first."""
    described, blocks, at = [], [], 0
    for name, array in sorted(arrays.items(), key=lambda item: -item[1].dtype.itemsize):
        block = array.tobytes()
        described.append({
            "name": name,
            "type": array.dtype.kind + str(8 * array.dtype.itemsize),
            "first": at,
            "count": array.size
        })
        blocks.append(block)
        at += len(block)
    return described, b"".join(blocks)


def _quantized_positions(position):
    """16-bit positions, all axes in one unit; differences from step to step, which compress well."""
    origin = position.min(axis=(0, 1)).astype(float)
    unit = max(float((position.max(axis=(0, 1)) - origin).max()), 1e-6) / 65535
    codes = numpy.rint((position - origin) / unit).astype("<u2")
    return origin, unit, _differences(codes)


def _quantized_orientations(orientation):
    """16-bit quaternions. q and -q are the same rotation; the sign is kept, so that steps differ little."""
    return _differences(numpy.rint(orientation * 32767).astype("<i2"))


def _differences(codes):
    return numpy.concatenate([codes[:1], codes[1:] - codes[:-1]])


def _colours(motion, kept, edges):
    """Indices in PART_COLOURS of the parts of every combination (k, c, n) and of the islands (k, n)."""
    centres = motion.position[numpy.searchsorted(motion.step, motion.measured.step[kept])].astype(float)
    part, island = motion.measured["part"][kept], motion.measured.island[kept]
    colour = numpy.zeros(part.shape, "u1")
    for combination in range(part.shape[1]):
        of_parts = colour_sequence(part[:, combination], edges, centres)
        colour[:, combination] = numpy.reshape(of_parts, part[:, combination].shape)
    return colour, numpy.reshape(colour_sequence(island, edges, centres), island.shape).astype("u1")


def _part_codes(part):
    """8 bits where the part ids allow it."""
    if part.size == 0 or part[part != NO_PART].max(initial=0) < 255:
        return numpy.where(part == NO_PART, 255, part).astype("u1"), 255
    return part.astype("<u2"), NO_PART


def _magnitude_codes(values):
    """8-bit logarithmic codes: 0 for zero, 255 for what is no number, 1..254 from the least to the most."""
    positive = values[numpy.isfinite(values) & (values > 0)]
    least, most = (float(positive.min()), float(positive.max())) if positive.size else (1.0, 1.0)
    most = max(most, least * 1.001)
    scaled = numpy.log(numpy.clip(values, least, most) / least) / numpy.log(most / least)
    codes = numpy.where(values > 0, 1 + numpy.rint(253 * numpy.nan_to_num(scaled)), 0)
    codes = numpy.where(numpy.isfinite(values), codes, 255)
    return {"least": least, "most": most}, codes.astype("u1")


def _geom(geom):
    size = [float(value) for value in geom.size]
    w, x, y, z = (float(value) for value in geom.orientation)
    described = {
        "body": geom.body,
        "kind": geom.kind,
        "size_m": size,
        "orientation_xyzw": [x, y, z, w],
        "position_m": [float(value) for value in geom.position]
    }
    if geom.kind == "convex":
        described["triangles_m"] = geom.corners[hull_triangles(geom.corners)].tolist()
    return described


def _ground(motion, extent):
    ground = ground_polygons(motion, extent)
    return [{
        "corners_m": corners.tolist(),
        "level": bool(normal[2] > 0.999),
        "lone": len(ground) == 1
    } for _, corners, normal in ground]


def _view(look, extent):
    """Where the eye stands as seen from the bodies; the page moves it to where it just holds them."""
    centre = (extent.low + extent.high) / 2
    return {
        "field_of_view": FIELD_OF_VIEW,
        "back": direction_to_eye(*(look.run_eye or look.eye)).tolist(),
        "centre_m": centre.tolist(),
        "radius_m": float((numpy.linalg.norm(extent.points - centre, axis=1) + extent.radii).max()),
    }


def _ramp():
    """256 colours for magnitudes, and a few of them for the legend."""
    colours = matplotlib.colormaps["viridis"](numpy.linspace(0, 1, 256))[:, :3]
    css = [matplotlib.colors.to_hex(colour) for colour in colours[::51]]
    return {"ramp": numpy.round(colours, 4).tolist(), "ramp_css": css}


def _note(motion, stride, unit_m):
    count, planned = len(motion.step), int(motion.attributes["steps"])
    text = (f"Positions are rounded to {1000 * unit_m / 2:.2g} mm, residuals and impulses to 254 logarithmic "
            "levels. ")
    if stride > 1:
        text += (
            f"To keep the page small, one of {stride} measured steps and one of {stride} steps are in it; "
            "the curves show all that were measured. ")
    if count < planned:
        text += f"The run ended early: {count} of {planned} steps were recorded. "
    return text
