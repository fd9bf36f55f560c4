"""How far the friction of a solved step is from Coulomb's law, read from the arrays of a problem file with one solution,
whatever model it was solved under.

A contact with the normal impulse n (below zero counts as zero), tangent impulses t and slacks w of its tangent rows, and the
largest diagonal entry d of J M^-1 J^T + C of its rows:

    friction_mismatch = sum |t - P(t - w / d)| / sum mu n        P: the nearest point of the disc of radius mu n

which is zero where friction is mu n against the sliding of what slides, and at most mu n where nothing slides. What slides so
slowly that less would stop it misses no more than that.
"""
import h5py
import numpy

from cleave_scripts.results.errors import ResultError


def friction_mismatch(path):
    """NaN where no contact carries anything."""
    names = ("mass", "row_body", "jacobian", "rhs", "compliance", "friction_row", "friction_coefficient")
    return mismatch_of(solved_arrays(path, names, ("impulse", "velocity")))


def solved_arrays(path, names, of_solution):
    """Arrays of a problem file with one solution, and arrays of that."""
    with h5py.File(path) as file:
        solutions = list(file.get("solution", {}).values())
        if len(solutions) != 1:
            raise ResultError(f"{path}: holds {len(solutions)} solutions, expected one")
        return {name: file[name][()] for name in names} | {name: solutions[0][name][()] for name in of_solution}


def mismatch_of(arrays):
    """arrays: by the names of a problem file, and `impulse` (m), `velocity` (n, 6) of the solution."""
    slack, diagonal = _slack_and_diagonal(arrays)
    impulse, mu = arrays["impulse"], arrays["friction_coefficient"]
    tangents = numpy.flatnonzero(mu > 0)
    normal, contact = numpy.unique(arrays["friction_row"][tangents], return_inverse=True)
    largest = diagonal[normal]
    numpy.maximum.at(largest, contact, diagonal[tangents])
    bound = numpy.zeros(len(normal))
    bound[contact] = mu[tangents] * numpy.maximum(impulse[normal[contact]], 0)
    if not bound.sum() > 0:
        return numpy.nan
    aim = impulse[tangents] - slack[tangents] / largest[contact]
    reach = _length(aim, contact, len(normal))
    shrink = numpy.divide(bound, reach, out=numpy.ones(len(normal)), where=reach > bound)
    return float(_length(impulse[tangents] - shrink[contact] * aim, contact, len(normal)).sum() / bound.sum())


def _length(values, contact, count):
    """(count) of the one or two tangents of every contact."""
    return numpy.sqrt(numpy.bincount(contact, values**2, count))


def _slack_and_diagonal(arrays):
    """(m) J v + C lambda - b and diag(J M^-1 J^T) + C."""
    inverse = numpy.linalg.inv(arrays["mass"])
    slack = arrays["compliance"] * arrays["impulse"] - arrays["rhs"]
    diagonal = arrays["compliance"].copy()
    for side in (0, 1):
        body, block = arrays["row_body"][:, side], arrays["jacobian"][:, 6 * side:6 * side + 6]
        there = body >= 0
        block, body = block[there], body[there]
        slack[there] += (block * arrays["velocity"][body]).sum(axis=1)
        diagonal[there] += numpy.einsum("ri,rij,rj->r", block, inverse[body], block)
    return slack, diagonal
