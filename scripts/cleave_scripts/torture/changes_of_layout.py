"""Types, shapes, links, storage and texts of a problem file that are changed. Tables as in changes_of_values.py."""
import os

import h5py
import numpy as np

from cleave_scripts.torture.changes_of_values import ANY, REFUSED, rewrite
from cleave_scripts.torture.foreign_file import FLOATS, GROUPS, INTEGERS, OPTIONAL, REQUIRED, REQUIRED_ATTRIBUTES

HUGE = (2**31, 2**33, 2**40, 2**55)
CONTROL_TEXTS = (b"a\nb", b"a\x1b[31mb", b"a\x7fb", b"\xff\xfe", b"\r")
TEXTS = ("a\nb", "a,b", 'a"b', "\x1b[31m", "a\x00b", "\x7f", "\u202e", "\u2028", "", " ", "-", "x" * 5000, "..", "/", "=1+1")
PER_BODY_OR_ROW = tuple(name for name in REQUIRED if name not in ("friction_row", "friction_coefficient"))


def _present(file, names, dice):
    return dice.choice([name for name in names if name in file])


def _missing(file, dice):
    del file[dice.choice(PER_BODY_OR_ROW)]


def _missing_attribute(file, dice):
    del file.attrs[dice.choice(REQUIRED_ATTRIBUTES)]


def _missing_optional(file, dice):
    del file[_present(file, OPTIONAL, dice)]


def _extra(file, dice):
    file["extra"] = np.arange(dice.randrange(1, 9))
    file.create_group("more/of/it")
    file.attrs["extra"] = dice.choice(["text", 1, 2.5])


def _exact_type(file, dice):
    """Types that PROBLEM_FILES.md converts."""
    if dice.random() < 0.5:
        name = _present(file, INTEGERS[:2], dice)
        rewrite(file, name, file[name][:].astype(dice.choice(["<i8", ">i4", ">i8"])))
    else:
        name = _present(file, FLOATS, dice)
        rewrite(file, name, file[name][:].astype(dice.choice(["<f4", ">f8", ">f4"])))


def _wrong_type(file, dice):
    name = _present(file, PER_BODY_OR_ROW, dice)
    shape, count = file[name].shape, file[name].size
    made = {
        "text": lambda: np.full(shape, b"1.0"),
        "variable text": lambda: np.full(shape, "1.0", object),
        "complex": lambda: np.ones(shape, complex),
        "compound": lambda: np.zeros(shape, [("a", "f8"), ("b", "i4")]),
        "opaque": lambda: np.zeros(shape, "V8"),
        "swapped": lambda: np.zeros(shape, "i8" if name != "row_body" else "f8"),
        "truth": lambda: np.ones(shape, bool),
        "array": lambda: np.zeros(shape, [("a", "f8", (3,))]),
    }
    chosen = dice.choice(list(made))
    if chosen == "variable text":
        del file[name]
        file.create_dataset(name, data=["1.0"] * count, dtype=h5py.string_dtype())
    else:
        rewrite(file, name, made[chosen]())


def _references(file, dice):
    name = _present(file, PER_BODY_OR_ROW, dice)
    shape, chosen = file[name].shape, dice.choice(["object", "region", "list"])
    kinds = {"object": h5py.ref_dtype, "region": h5py.regionref_dtype, "list": h5py.vlen_dtype(np.float64)}
    del file[name]
    data = file.create_dataset(name, shape, dtype=kinds[chosen])
    if chosen == "object" and data.size:
        data[(0,) * len(shape)] = file.ref


def _wrong_shape(file, dice):
    name = _present(file, PER_BODY_OR_ROW, dice)
    data = file[name][:]
    changes = (lambda: data.ravel()[:-1], lambda: data[None], lambda: data[..., None], lambda: data[:0], lambda: data[1:],
               lambda: np.concatenate([data, data[:1]]), lambda: data.ravel()[0],
               lambda: np.zeros((1, ) * 20))
    changed = dice.choice(changes)()
    rewrite(file, name, changed if changed.shape != data.shape else data[:-1])


def _null_space(file, dice):
    name = _present(file, PER_BODY_OR_ROW, dice)
    rewrite(file, name, h5py.Empty(file[name].dtype))


def _huge(file, dice):
    """So many values are declared and none stored."""
    name = dice.choice(PER_BODY_OR_ROW)
    rest, kind = file[name].shape[1:], file[name].dtype
    del file[name]
    length = dice.choice(HUGE)
    if dice.random() < 0.5:
        file.create_dataset(name, (length, *rest), dtype=kind, chunks=(64, *rest))
    else:
        space = h5py.h5s.create_simple((length, *rest))
        h5py.h5d.create(file.id, name.encode(), h5py.h5t.py_create(kind), space)


def _all_huge(file, dice):
    """Sizes that agree with each other."""
    rows = dice.choice(HUGE[:2])
    for name in ("row_body", "jacobian", "rhs", "compliance", "lower", "upper", "friction_row", "friction_coefficient",
                 "row_kind", "row_constraint", "contact_point", "warm_impulse", "contact_set"):
        if name in file:
            rest, kind = file[name].shape[1:], file[name].dtype
            del file[name]
            file.create_dataset(name, (rows, *rest), dtype=kind, chunks=(64, *rest))


def _filtered(file, dice):
    name = _present(file, (*REQUIRED, *OPTIONAL), dice)
    if file[name].size:
        options = dice.choice([{"compression": "gzip"}, {"shuffle": True}, {"fletcher32": True}, {"compression": "lzf"},
                               {"chunks": True, "maxshape": (None, ) * file[name].ndim}])
        rewrite(file, name, file[name][:], **options)


def _external_storage(file, dice):
    name = _present(file, PER_BODY_OR_ROW, dice)
    shape, kind, size = file[name].shape, file[name].dtype, file[name].size * file[name].dtype.itemsize
    place = _place(file, dice)
    del file[name]
    file.create_dataset(name, shape, dtype=kind, external=[(place, 0, max(size, 1))])


def _virtual(file, dice):
    name = _present(file, PER_BODY_OR_ROW, dice)
    shape, kind = file[name].shape, file[name].dtype
    layout = h5py.VirtualLayout(shape, kind)
    layout[...] = h5py.VirtualSource(dice.choice([_place(file, dice), "."]), "warm_impulse", shape)
    del file[name]
    file.create_virtual_dataset(name, layout)


def _external_link(file, dice):
    name = dice.choice([*PER_BODY_OR_ROW, *GROUPS])
    if name in file:
        del file[name]
    file[name] = h5py.ExternalLink(_place(file, dice), "/" + dice.choice(["mass", name]))


def _place(file, dice):
    """A file of another kind, made beside the problem file where it has to be made."""
    directory = os.path.dirname(file.filename)
    chosen = dice.choice(["fifo", "bytes", "missing", "/dev/zero", "/proc/self/mem", os.path.basename(file.filename)])
    if chosen == "fifo" and not os.path.exists(os.path.join(directory, "fifo")):
        os.mkfifo(os.path.join(directory, "fifo"))
    if chosen == "bytes":
        with open(os.path.join(directory, "bytes"), "wb") as beside:
            beside.write(bytes(1 << 16))
    return chosen


def _soft_link(file, dice):
    name = dice.choice(PER_BODY_OR_ROW)
    if dice.random() < 0.5:
        file.move(name, "elsewhere")
        file[name] = h5py.SoftLink("/elsewhere")
    else:
        del file[name]
        file[name] = h5py.SoftLink(dice.choice(["/nowhere", "/" + name, "/"]))


def _hard_link(file, dice):
    file["again"] = file[_present(file, (*REQUIRED, *OPTIONAL), dice)]
    file.create_group("circle")["round"] = file["/"]


def _group_for_dataset(file, dice):
    name = dice.choice(PER_BODY_OR_ROW)
    del file[name]
    if dice.random() < 0.5:
        file.create_group(name)
    else:
        file[name] = np.dtype("f8")


def _dataset_for_group(file, dice):
    name = dice.choice(GROUPS)
    if name in file:
        del file[name]
    file[name] = np.arange(3)


def _text(file, dice):
    name = dice.choice(["scene", "friction_model"])
    text = dice.choice(TEXTS)
    file.attrs[name] = np.bytes_(text.encode()) if "\x00" in text or dice.random() < 0.5 else text


def _control_text(file, dice):
    file.attrs[dice.choice(["scene", "friction_model"])] = np.bytes_(dice.choice(CONTROL_TEXTS))


def _wrong_schema(file, dice):
    file.attrs["schema"] = dice.choice(["cleave-problem-2", "cleave-problem-3", "", "cleave-problem-1\n",
                                        "cleave-problem-11", "CLEAVE"])


def _wrong_attribute(file, dice):
    name = dice.choice(["schema", "h_s"])
    values = [np.arange(3), np.zeros((2, 2)), h5py.Empty("f8"), h5py.Empty("S4"), np.complex128(1), [b"a", b"b"], True]
    values += [7.5] if name == "schema" else ["text", "0.01"]
    file.attrs[name] = dice.choice(values)


def _attribute_reference(file, dice):
    file.attrs[dice.choice(["schema", "h_s"])] = dice.choice([file.ref, file["mass"].regionref[...]])


def _odd_attribute(file, dice):
    name = dice.choice(["scene", "step", "seed", "friction_model", "erp", "cfm"])
    file.attrs[name] = dice.choice([np.arange(3), h5py.Empty("f8"), 2**63, -1, 1e300, float("nan"), b"\xff\xfe", True,
                                    np.uint64(2**64 - 1), np.float32(0.5), ["a", "b"], np.complex128(1)])


CHANGES = (
    ("an array missing", REFUSED, _missing),
    ("an attribute missing", REFUSED, _missing_attribute),
    ("an optional array missing", ANY, _missing_optional),
    ("more than there should be", ANY, _extra),
    ("a type that is converted", ANY, _exact_type),
    ("a type that is not converted", REFUSED, _wrong_type),
    ("references or lists as numbers", REFUSED, _references),
    ("a shape that disagrees", REFUSED, _wrong_shape),
    ("an array without a size", REFUSED, _null_space),
    ("an array of a huge declared size", REFUSED, _huge),
    ("huge declared sizes that agree", REFUSED, _all_huge),
    ("filters and chunks", ANY, _filtered),
    ("external storage", REFUSED, _external_storage),
    ("a virtual array", REFUSED, _virtual),
    ("an external link", REFUSED, _external_link),
    ("a soft link", REFUSED, _soft_link),
    ("hard links in a circle", ANY, _hard_link),
    ("a group or a type for an array", REFUSED, _group_for_dataset),
    ("an array for a group", ANY, _dataset_for_group),
    ("another text", ANY, _text),
    ("a text of control characters", REFUSED, _control_text),
    ("another schema", REFUSED, _wrong_schema),
    ("an attribute of another type", REFUSED, _wrong_attribute),
    ("a reference for an attribute", REFUSED, _attribute_reference),
    ("an odd optional attribute", ANY, _odd_attribute),
)
