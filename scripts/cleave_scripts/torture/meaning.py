"""What a problem file says to a reader of PROBLEM_FILES.md, with what it leaves out filled in."""
import h5py
import numpy as np

from cleave_scripts.torture.foreign_file import GROUPS, OPTIONAL_ATTRIBUTES, REQUIRED, REQUIRED_ATTRIBUTES

TEXTS = {"scene": "-", "friction_model": "-"}


def meaning(path):
    """{name: bytes or text}. Call it guarded: the file may be damaged."""
    with h5py.File(path) as file:
        arrays = {name: file[name][()] for name in REQUIRED}
        kind = file["row_kind"][()] if "row_kind" in file else _kinds(arrays)
        arrays |= {"row_kind": kind, "row_constraint": _constraints(file, arrays, kind)}
        arrays |= {name: file[name][()] if name in file else value for name, value in _zeros(arrays).items()}
        told = {name: (values.shape, values.astype(np.float64).tobytes()) for name, values in arrays.items()}
        told |= {f"@{name}": _text(file.attrs.get(name, TEXTS.get(name, 0)))
                 for name in (*REQUIRED_ATTRIBUTES, *OPTIONAL_ATTRIBUTES)}
        for name in GROUPS:
            told |= _group(file[name], name) if name in file else {}
        return told


def _zeros(arrays):
    """Defaults that depend on sizes alone."""
    bodies, rows = len(arrays["mass"]), len(arrays["rhs"])
    return {"contact_point": np.zeros((rows, 3)), "warm_impulse": np.zeros(rows), "contact_set": np.zeros(rows),
            "position": np.zeros((bodies, 3)),
            "orientation": np.tile([1.0, 0, 0, 0], (bodies, 1)), "body_group": np.zeros(0)}


def _kinds(arrays):
    free_below = np.isneginf(arrays["lower"])
    free_above = np.isposinf(arrays["upper"])
    without = np.where(free_below & free_above, 0, np.where(free_above & (arrays["lower"] == 0), 1, 2))
    return np.where(arrays["friction_row"] >= 0, 2, without)


def _constraints(file, arrays, kind):
    """Numbers of constraints in their order; ids that come again later are others."""
    bodies = arrays["row_body"]
    begins = np.ones(len(kind), bool)
    if "row_constraint" in file:
        ids = file["row_constraint"][()]
        begins[1:] = ids[1:] != ids[:-1]
    else:
        other = (bodies[1:] != bodies[:-1]).any(1)
        begins[1:] = other | (kind[1:] == 1) | ((kind[1:] == 0) & (kind[:-1] != 0))
    return np.cumsum(begins)


def _group(group, prefix):
    told = {f"{prefix}@{name}": _text(value) for name, value in group.attrs.items()}
    for name, item in group.items():
        if isinstance(item, h5py.Group):
            told |= _group(item, f"{prefix}/{name}")
        else:
            told[f"{prefix}/{name}"] = item.shape, item[()].tobytes()
    return told


def _text(value):
    return value.decode("utf-8", "backslashreplace") if isinstance(value, bytes) else str(value)
