"""Solvers that were run with several numbers of sweeps or iterations."""
import re

from cleave_scripts.figures.choose import SOLVER_OPTIONS

COUNT = re.compile(r", (\d+) (sweeps|iterations)$")
DEFAULT_COUNTS = {
    "pgs": (int(SOLVER_OPTIONS["sweeps"]), "sweeps"),
    "ode-quickstep": (int(SOLVER_OPTIONS["quickstep-iterations"]), "iterations")
}


def solver_of(label):
    """The solver of a label like 'pgs, 100 sweeps'."""
    return label.partition(",")[0]


def _count(label):
    """(number, what it counts) of a label like 'pgs, 100 sweeps'; without a word it is the default."""
    found = COUNT.search(label)
    return (int(found.group(1)), found.group(2)) if found else DEFAULT_COUNTS.get(label, (None, ""))


def count_text(label, with_unit):
    number, unit = _count(label)
    return f"{number} {unit}" if with_unit else str(number)


def families(table):
    """{solver: its rows, fewest sweeps first} of the solvers that have rows with several numbers of them."""
    counts = table["label"].map(lambda label: _count(label)[0])
    rows = table.assign(count=counts)[counts.notna()]
    found = {
        solver: family.sort_values("count") for solver, family in rows.groupby(rows["label"].map(solver_of))
    }
    return {solver: family for solver, family in found.items() if family["count"].nunique() > 1}


def full_name(label):
    """The label, with the number of sweeps or iterations also where it is the default."""
    return f"{label}, {count_text(label, with_unit=True)}" if label in DEFAULT_COUNTS else label
