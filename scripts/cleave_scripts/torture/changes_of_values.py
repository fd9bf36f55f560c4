"""Numbers of a problem file that are changed, each by itself. A change takes an open file and the dice.

Each stands in the table with what has to come of it: REFUSED where PROBLEM_FILES.md does not allow the result, else ANY,
whereupon the judge looks at what was made of it.
"""
import numpy as np

from cleave_scripts.torture.foreign_file import FLOATS, INTEGERS, PER_ROW

REFUSED, ANY = "refused", "any"
EXTREMES = (1e308, -1e308, 1e200, 1e-200, 5e-324, -0.0, 1e20, -1e20, 1e12, 1.0)
WILD = (2**31 - 1, -2**31, -2, 10**6, 4097)


def put(file, name, value, dice):
    """At a random place of an array."""
    data = file[name]
    if data.size:
        place = tuple(dice.randrange(length) for length in data.shape)
        data[place] = value


def rewrite(file, name, array, **options):
    """The array in place of the one there, whatever its type and shape."""
    if name in file:
        del file[name]
    return file.create_dataset(name, data=array, **options)


def rows_of_kind(file, kind):
    return np.flatnonzero(file["row_kind"][:] == kind)


def _no_number(file, dice):
    put(file, dice.choice(FLOATS), np.nan, dice)


def _infinite(file, dice):
    put(file, dice.choice([name for name in FLOATS if name not in ("lower", "upper")]), dice.choice([np.inf, -np.inf]), dice)


def _infinite_bound(file, dice):
    name = dice.choice(["lower", "upper"])
    put(file, name, np.inf if name == "lower" else -np.inf, dice)


def _extreme(file, dice):
    put(file, dice.choice(FLOATS), dice.choice(EXTREMES), dice)


def _all_scaled(file, dice):
    name = dice.choice(FLOATS)
    file[name][...] = file[name][...] * 10.0**dice.choice([-300, -150, -20, -6, 6, 20, 150, 300])


def _swapped_bounds(file, dice):
    row = dice.randrange(len(file["lower"]))
    file["lower"][row], file["upper"][row] = 1.0 + dice.random(), -dice.random()


def _negative_compliance(file, dice):
    put(file, "compliance", -10.0**dice.uniform(-300, 3), dice)


def _no_compliance(file, dice):
    file["compliance"][...] = 0


def _lopsided_mass(file, dice):
    body = dice.randrange(len(file["mass"]))
    file["mass"][body, 0, 4] = file["mass"][body, 0, 0] * dice.uniform(0.1, 0.9)


def _indefinite_mass(file, dice):
    body, place = dice.randrange(len(file["mass"])), dice.randrange(6)
    file["mass"][body, place, place] = dice.choice([0.0, -1.0, -1e-300])


def _mass_ratio(file, dice):
    body = dice.randrange(len(file["mass"]))
    file["mass"][body] = file["mass"][body] * 10.0**dice.uniform(-9, 9)


def _body_outside(file, dice):
    row = dice.randrange(len(file["row_body"]))
    file["row_body"][row, 0] = dice.choice([*WILD, -1, len(file["mass"])])


def _second_body_outside(file, dice):
    row = dice.randrange(len(file["row_body"]))
    file["row_body"][row, 1] = dice.choice([*WILD, len(file["mass"])])


def _same_body_twice(file, dice):
    row = dice.randrange(len(file["row_body"]))
    file["row_body"][row] = 0


def _other_bodies(file, dice):
    row, bodies = dice.randrange(len(file["row_body"])), len(file["mass"])
    file["row_body"][row] = dice.randrange(bodies), dice.randrange(-1, bodies)


def _wild_index(file, dice):
    put(file, dice.choice([name for name in INTEGERS if name not in ("row_body", "row_kind")]), dice.choice(WILD), dice)


def _friction_row_outside(file, dice):
    put(file, "friction_row", dice.choice([*WILD, len(file["rhs"])]), dice)


def _friction_row_of_itself(file, dice):
    row = dice.randrange(len(file["friction_row"]))
    file["friction_row"][row] = row


def _friction_row_elsewhere(file, dice):
    put(file, "friction_row", dice.randrange(-1, len(file["rhs"])), dice)


def _friction_on_another_row(file, dice):
    others = np.flatnonzero(file["row_kind"][:] != 2)
    if len(others):
        file["friction_coefficient"][dice.choice(list(others))] = dice.uniform(0.01, 2)
    else:
        file["friction_coefficient"][0] = -1.0


def _negative_friction(file, dice):
    put(file, "friction_coefficient", -dice.random() - 1e-9, dice)


def _unknown_kind(file, dice):
    put(file, "row_kind", dice.choice([3, 7, 255]), dice)


def _other_kind(file, dice):
    put(file, "row_kind", dice.randrange(3), dice)


def _swapped_rows(file, dice):
    """Two rows change places in every array but friction_row, which keeps pointing where it did."""
    first, second = dice.randrange(len(file["rhs"])), dice.randrange(len(file["rhs"]))
    for name in PER_ROW:
        if name in file and name != "friction_row":
            rows = file[name][:]
            rows[[first, second]] = rows[[second, first]]
            file[name][...] = rows


def _swapped_friction_rows(file, dice):
    friction = rows_of_kind(file, 2)
    if len(friction) > 1:
        first, second = dice.sample(list(friction), 2)
        rows = file["friction_row"][:]
        rows[[first, second]] = rows[[second, first]]
        file["friction_row"][...] = rows


def _doubled_rows(file, dice):
    first = dice.randrange(len(file["rhs"]))
    _take_rows(file, np.concatenate([np.arange(first + 1), np.arange(first, len(file["rhs"]))]))


def _removed_rows(file, dice):
    keep = np.array([row for row in range(len(file["rhs"])) if dice.random() < 0.8], int)
    _take_rows(file, keep)


def _no_rows(file, _dice):
    _take_rows(file, np.zeros(0, int))


def _take_rows(file, rows):
    for name in PER_ROW:
        if name in file:
            rewrite(file, name, file[name][:][rows])


def _zero_jacobian(file, dice):
    file["jacobian"][dice.randrange(len(file["rhs"]))] = 0


def _constraint_ids(file, dice):
    file["row_constraint"][...] = [dice.choice([0, 1, -1, 2**31 - 1]) for _ in range(len(file["rhs"]))]


def _sets(file, dice):
    """Contacts with a cone or Coulomb's law in the place of their boxes."""
    rows = np.flatnonzero((file["row_kind"][:] == 2) & (file["friction_coefficient"][:] > 0))
    sets = np.zeros(len(file["rhs"]), "u1")
    sets[file["friction_row"][:][rows]] = dice.choice([1, 2])
    rewrite(file, "contact_set", sets)
    lower, upper = file["lower"][:], file["upper"][:]
    lower[rows], upper[rows] = -np.inf, np.inf
    file["lower"][...], file["upper"][...] = lower, upper
    file.attrs["schema"] = "cleave-problem-2"
    return rows


def _some_sets(file, dice):
    """Boxes beside them: those without bounds carry what they must."""
    _sets(file, dice)
    for row in rows_of_kind(file, 1):
        if dice.random() < 0.3:
            file["contact_set"][row] = dice.randrange(3) if file["contact_set"][row] else 0


def _unknown_set(file, dice):
    _sets(file, dice)
    put(file, "contact_set", dice.choice([3, 7, 255]), dice)


def _set_of_no_contact(file, dice):
    _sets(file, dice)
    others = np.flatnonzero(file["row_kind"][:] != 1)
    row = dice.choice(list(others)) if len(others) else 0
    file["contact_set"][row] = 1 if len(others) else 9


def _bounds_beside_a_set(file, dice):
    rows = _sets(file, dice)
    if len(rows):
        file[dice.choice(["lower", "upper"])][dice.choice(list(rows))] = 0.0
    else:
        file["contact_set"][0] = 9


def _set_in_the_first_schema(file, dice):
    _sets(file, dice)
    file.attrs["schema"] = "cleave-problem-1"


def _wild_step(file, dice):
    file.attrs["h_s"] = dice.choice([0.0, -1.0, float("nan"), float("inf"), -float("inf"), -0.0])


def _other_step(file, dice):
    file.attrs["h_s"] = 10.0**dice.uniform(-300, 300)


CHANGES = (
    ("a number that is none", REFUSED, _no_number),
    ("an infinite number", REFUSED, _infinite),
    ("a bound infinite on the wrong side", REFUSED, _infinite_bound),
    ("an extreme number", ANY, _extreme),
    ("an array scaled", ANY, _all_scaled),
    ("lower above upper", REFUSED, _swapped_bounds),
    ("negative compliance", REFUSED, _negative_compliance),
    ("no compliance", ANY, _no_compliance),
    ("a mass that is not symmetric", REFUSED, _lopsided_mass),
    ("a mass that is not positive definite", REFUSED, _indefinite_mass),
    ("a mass scaled", ANY, _mass_ratio),
    ("a body that is not there", REFUSED, _body_outside),
    ("a second body that is not there", REFUSED, _second_body_outside),
    ("a row between a body and itself", ANY, _same_body_twice),
    ("a row between other bodies", ANY, _other_bodies),
    ("a wild index", ANY, _wild_index),
    ("a normal row that is not there", REFUSED, _friction_row_outside),
    ("a friction row of itself", REFUSED, _friction_row_of_itself),
    ("another normal row", ANY, _friction_row_elsewhere),
    ("friction on a row without", REFUSED, _friction_on_another_row),
    ("negative friction", REFUSED, _negative_friction),
    ("a kind of row that is none", REFUSED, _unknown_kind),
    ("another kind of row", ANY, _other_kind),
    ("rows swapped", ANY, _swapped_rows),
    ("friction rows swapped", ANY, _swapped_friction_rows),
    ("a row doubled", ANY, _doubled_rows),
    ("rows removed", ANY, _removed_rows),
    ("no rows", ANY, _no_rows),
    ("a row without Jacobian", ANY, _zero_jacobian),
    ("ids of constraints", ANY, _constraint_ids),
    ("a step that is none", REFUSED, _wild_step),
    ("another step", ANY, _other_step),
    ("contacts with a cone or Coulomb's law", ANY, _sets),
    ("such contacts beside others", ANY, _some_sets),
    ("a set of a contact that is none", REFUSED, _unknown_set),
    ("a set of a row that begins no contact", REFUSED, _set_of_no_contact),
    ("bounds beside a set", REFUSED, _bounds_beside_a_set),
    ("sets in a file of the first schema", REFUSED, _set_in_the_first_schema),
)
