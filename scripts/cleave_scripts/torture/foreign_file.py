"""A problem file written again by h5py with what PROBLEM_FILES.md names and nothing else, as other programs write them."""
import h5py

REQUIRED = ("mass", "free_velocity", "row_body", "jacobian", "rhs", "compliance", "lower", "upper", "friction_row",
            "friction_coefficient")
OPTIONAL = ("row_kind", "row_constraint", "contact_point", "warm_impulse", "position", "orientation", "body_group",
            "contact_set")
REQUIRED_ATTRIBUTES = ("schema", "h_s")
OPTIONAL_ATTRIBUTES = ("scene", "step", "seed", "friction_model", "erp", "cfm")
FLOATS = ("mass", "free_velocity", "jacobian", "rhs", "compliance", "lower", "upper", "friction_coefficient",
          "contact_point", "warm_impulse", "position", "orientation")
INTEGERS = ("row_body", "friction_row", "row_kind", "row_constraint")
PER_ROW = ("row_body", "jacobian", "rhs", "compliance", "lower", "upper", "friction_row", "friction_coefficient", "row_kind",
           "row_constraint", "contact_point", "warm_impulse", "contact_set")
GROUPS = ("shape", "solution", "partition")


def write_foreign(source, target):
    with h5py.File(source) as read, h5py.File(target, "w") as written:
        for name in (*REQUIRED_ATTRIBUTES, *OPTIONAL_ATTRIBUTES):
            if name in read.attrs:
                written.attrs[name] = read.attrs[name]
        for name in (*REQUIRED, *OPTIONAL):
            if name in read:
                written[name] = read[name][()]
        for name in GROUPS:
            if name in read:
                read.copy(name, written)
