"""Reads motion.h5, which `cleave run --record-motion` writes; harness/files/motion_file.h says what is in it.

A file that is still being written, or whose run was killed, is read as far as it is complete. Errors are
ResultError, one line that names the file.
"""
import dataclasses
import pathlib
import re

import h5py
import numpy

from cleave_scripts.motion.shapes import Geom, relative_pose
from cleave_scripts.results.campaign import run_files_below
from cleave_scripts.results.errors import ResultError

FILE_NAME = "motion.h5"
SCHEMA = "cleave-motion-1"
SEPARATOR = re.compile(r"(?<!\de)\+")  # of the names of a combination; that of 1e+06 is none
NO_PART = 65535
# Arrays with one entry a measured step and combination, and what an entry is besides.
PER_COMBINATION = {
    "part": "n",
    "interface": "n",
    "residual_m_per_s": "n",
    "largest_impulse_n_s": "n",
    "t_s_ms": "",
    "t_pr_ms": "",
    "interface_rows": "",
    "ok": ""
}
GEOM_TYPES = ("box", "sphere", "capsule", "cylinder", "convex", "plane")


@dataclasses.dataclass
class Measured:
    """What was measured: k steps, c combinations, n bodies. Arrays by name as in the file."""

    step: numpy.ndarray
    island: numpy.ndarray
    edge: numpy.ndarray
    first_edge: numpy.ndarray  # (k + 1): edges of measured step i are edge[first_edge[i]:first_edge[i + 1]]
    arrays: dict

    def edges(self, index):
        return self.edge[self.first_edge[index]:self.first_edge[index + 1]]

    def __getitem__(self, name):
        return self.arrays[name]


@dataclasses.dataclass
class Motion:
    """One recorded run."""

    path: pathlib.Path
    name: str  # of its run
    attributes: dict
    combinations: list  # (partitioner, refiner, solver)
    mass_kg: numpy.ndarray
    step: numpy.ndarray
    position: numpy.ndarray
    orientation: numpy.ndarray
    geoms: list
    measured: Measured

    @property
    def scene(self):
        return self.attributes["scene"]

    @property
    def bodies(self):
        return len(self.mass_kg)

    def measured_index(self, step):
        """The last measured step that is not after `step`, as an index; None before the first one."""
        index = int(numpy.searchsorted(self.measured.step, step, side="right")) - 1
        return index if index >= 0 else None


def find_recordings(directory):
    """{name: motion.h5} of every run in a directory or below, in order."""
    return dict(run_files_below(directory, FILE_NAME))


def load_motion(path):
    path = pathlib.Path(path)
    try:
        with h5py.File(path, "r", swmr=True) as file:
            return _read(path, file)
    except OSError as error:
        reason = error.strerror if isinstance(error, FileNotFoundError) else "not a readable HDF5 file"
        raise ResultError(f"{path}: {reason}") from None
    except KeyError as error:
        raise ResultError(f"{path}: {error.args[0]} is missing") from None


def load_motions(directory):
    """All recordings in a directory or below."""
    found = find_recordings(directory)
    motions = {name: load_motion(path) for name, path in found.items()}
    return [dataclasses.replace(motion, name=pathlib.PurePath(name).name or motion.name) for name, motion in motions.items()]


def _read(path, file):
    schema = _text(file.attrs.get("schema", "none"))
    if schema != SCHEMA:
        raise ResultError(f"{path}: schema = {schema}, expected {SCHEMA}")
    names = ("run_id", "scene", "seed", "h_s", "steps", "measure_every", "combinations")
    attributes = {name: _attribute(path, file, name) for name in names}
    combinations = [tuple(SEPARATOR.split(label)) for label in attributes["combinations"].split(",")]
    mass_kg = _array(path, file, "mass")
    n = len(mass_kg)
    step = _array(path, file, "step")
    if len(step) == 0:
        raise ResultError(f"{path}: no step is complete yet")
    position = _array(path, file, "position", len(step), (n, 3))
    orientation = _array(path, file, "orientation", len(step), (n, 4))
    measured = _read_measured(path, file, n, len(combinations))
    geoms = _read_geoms(path, file, position[0], orientation[0])
    name = path.resolve().parent.name
    return Motion(path, name, attributes, combinations, mass_kg, step, position, orientation, geoms, measured)


def _attribute(path, file, name):
    if name not in file.attrs:
        raise ResultError(f"{path}: attribute {name} is missing")
    return _text(file.attrs[name])


def _text(value):
    """h5py gives texts of fixed length as bytes."""
    return value.decode() if isinstance(value, bytes) else value


def _array(path, file, name, count=None, entry=None):
    """The first `count` entries of a dataset, or all of them."""
    if name not in file:
        raise ResultError(f"{path}: dataset {name} is missing")
    values = file[name][:count]
    if count is not None and values.shape != (count, *entry):
        raise ResultError(f"{path}: shape of {name} = {values.shape}, expected {(count, *entry)}")
    return values


def _read_measured(path, file, n, c):
    step = _array(path, file, "measured/step")
    k = len(step)
    arrays = {
        name: _array(path, file, f"measured/{name}", k, (c, n) if entry else (c,))
        for name, entry in PER_COMBINATION.items()
    }
    edge_count = _array(path, file, "measured/edge_count", k, ())
    first_edge = numpy.concatenate([[0], numpy.cumsum(edge_count, dtype=int)])
    edge = _array(path, file, "measured/edge", int(first_edge[-1]), (2,))
    if edge.size and edge.max() >= n:
        raise ResultError(f"{path}: measured/edge names body {edge.max()} of {n}")
    return Measured(step, _array(path, file, "measured/island", k, (n,)), edge, first_edge, arrays)


def _read_geoms(path, file, position, orientation):
    """Geoms with poses relative to their bodies; those of static ones stay in the world."""
    read = {
        name: _array(path, file, f"shape/{name}")
        for name in ("geom_body", "geom_type", "geom_size", "geom_position", "geom_orientation",
                     "convex_points", "convex_first")
    }
    geoms = []
    for i, body in enumerate(read["geom_body"]):
        pose = (read["geom_position"][i], read["geom_orientation"][i])
        if body >= 0:
            pose = relative_pose((position[body], orientation[body]), pose)
        if read["geom_type"][i] >= len(GEOM_TYPES):
            raise ResultError(f"{path}: shape/geom_type holds {read['geom_type'][i]}, which is unknown")
        corners = read["convex_points"][read["convex_first"][i]:read["convex_first"][i + 1]]
        geoms.append(
            Geom(int(body), GEOM_TYPES[read["geom_type"][i]], read["geom_size"][i], pose[0], pose[1],
                 corners))
    return geoms
