"""A recording as the viewer's page reads it: a description in JSON, and all numbers in one compressed block."""
import base64
import gzip
import json

import matplotlib
import numpy

from cleave_scripts.motion.colours import EDGE, EDGE_CASING, EDGE_CASING_SCALE, INNER_EDGE, NODE, PART_COLOURS
from cleave_scripts.motion.looks import Extent, ground_polygons, look_of
from cleave_scripts.motion.part_colouring import colour_sequence
from cleave_scripts.motion.povray_scene import direction_to_eye
from cleave_scripts.motion.shapes import hull_triangles
from cleave_scripts.viewer.codes import (join, magnitude_codes, part_codes, quantized_orientations,
                                         quantized_positions)

FIELD_OF_VIEW = 19  # degrees, from the lower to the upper edge


def pack(motion, stride):
    """A recording as JSON: a description and all numbers, compressed. See viewer/web/source/recording.js."""
    kept = numpy.arange(len(motion.measured.step))[::-1][::stride][::-1]  # the last one always
    arrays, codes = _arrays(motion, stride, kept)
    described, data = join(arrays)
    description = {"arrays": described, **codes, **_description(motion), "note": _note(motion, stride, codes["unit_m"])}
    packed = {"description": description, "data": base64.b64encode(gzip.compress(data, 6, mtime=0)).decode()}
    return json.dumps(packed).replace("</", "<\\/")


def _frames(motion, stride, kept):
    """Every stride-th, and those of the measured steps that are kept."""
    return numpy.unique(
        numpy.concatenate([numpy.arange(len(motion.step))[::stride],
                           numpy.searchsorted(motion.step, motion.measured.step[kept])]))


def _arrays(motion, stride, kept):
    """({name: numbers}, what the codes among them mean)"""
    measured, frames = motion.measured, _frames(motion, stride, kept)
    origin, unit, position = quantized_positions(motion.position[frames])
    parts, no_part = part_codes(measured["part"][kept])
    edges = [measured.edges(index) for index in kept]
    part_colour, island_colour = _colours(motion, kept, edges)
    residual_range, residual = magnitude_codes(measured["residual_m_per_s"][kept])
    impulse_range, impulse = magnitude_codes(measured["largest_impulse_n_s"][kept])
    arrays = {
        "step": motion.step[frames].astype("<i4"),
        "position": position,
        "orientation": quantized_orientations(motion.orientation[frames]),
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
    return arrays, {"origin_m": origin.tolist(), "unit_m": unit, "no_part": no_part,
                    "ranges": {"residual": residual_range, "impulse": impulse_range}}


def _description(motion):
    """What does not change from frame to frame."""
    extent = Extent.of(motion, _settling_frames(motion))
    return {
        "bodies": motion.bodies,
        "planned_steps": int(motion.attributes["steps"]),
        "h_s": float(motion.attributes["h_s"]),
        "combinations": [_combination_name(names) for names in motion.combinations],
        "mass_kg": motion.mass_kg.tolist(),
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
    }


def _settling_frames(motion):
    """Some frames whose bodies set the size of ground and shadows; in the first ones they may be far above."""
    last = len(motion.step) - 1
    return numpy.linspace(last // 6, last, 12).astype(int)


def _combination_name(names):
    partitioner, refiner, solver = names
    return solver if partitioner == "-" else f"{partitioner} + {refiner}, {solver}"


def _colours(motion, kept, edges):
    """Indices in PART_COLOURS of the parts of every combination (k, c, n) and of the islands (k, n)."""
    centres = motion.position[numpy.searchsorted(motion.step, motion.measured.step[kept])].astype(float)
    part, island = motion.measured["part"][kept], motion.measured.island[kept]
    colour = numpy.zeros(part.shape, "u1")
    for combination in range(part.shape[1]):
        of_parts = colour_sequence(part[:, combination], edges, centres)
        colour[:, combination] = numpy.reshape(of_parts, part[:, combination].shape)
    return colour, numpy.reshape(colour_sequence(island, edges, centres), island.shape).astype("u1")


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
