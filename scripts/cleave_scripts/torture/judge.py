"""A judge of its own: how far impulses are from solving a problem file, by numpy in extended precision.

It is written from harness/files/PROBLEM_FILES.md and the definition of the residual in solver/residual.h, and shares
nothing with the program.
"""
import dataclasses

import h5py
import numpy as np

EXACT_LIMIT = 1e-9
SLACK = 1.001  # of the limit: where the last digit of a residual decides, both judges are right
ROUNDING = 16 * np.finfo(np.float64).eps
EXTENDED = np.longdouble


@dataclasses.dataclass(frozen=True)
class Verdict:
    residual: float  # m/s; infinite where an impulse is no number
    limit: float  # of a row that says ok
    rounding: float  # what the rounding of the impulses to 64 bits can make of a residual
    velocity_error: float  # of the stored velocity; nan where none is stored

    def above(self):
        return not self.residual <= SLACK * self.limit + self.rounding

    def differs_from(self, told):
        """Whether a residual that somebody tells is another one."""
        return not abs(told - self.residual) <= 1e-6 * abs(self.residual) + self.rounding


class Problem:
    """The arrays of a problem file that say what is solved."""

    def __init__(self, file):
        self.mass = file["mass"][:].astype(EXTENDED)
        self.free_velocity = file["free_velocity"][:].astype(EXTENDED)
        self.bodies = file["row_body"][:].astype(np.int64).reshape(-1, 2)
        self.jacobian = file["jacobian"][:].astype(EXTENDED).reshape(-1, 2, 6)
        self.jacobian[self.bodies[:, 1] < 0, 1] = 0
        self.rhs, self.compliance, self.lower, self.upper = (file[name][:].astype(EXTENDED)
                                                             for name in ("rhs", "compliance", "lower", "upper"))
        self.inverse_mass = inverses(self.mass)
        self.contacts = _contacts(file) if "contact_set" in file else []

    def velocity(self, impulse):
        """v0 + M^-1 J^T impulse, (n, 6)"""
        force = np.zeros_like(self.free_velocity)
        for side in (0, 1):
            held = self.bodies[:, side] >= 0
            np.add.at(force, self.bodies[held, side], (self.jacobian[:, side] * impulse[:, None])[held])
        return self.free_velocity + np.einsum("nij,nj->ni", self.inverse_mass, force)

    def along_rows(self, velocity):
        """J v, (m)"""
        return sum((self.jacobian[:, side] * velocity[self.bodies[:, side]]).sum(1) for side in (0, 1)) if len(self.rhs) \
            else np.zeros(0, EXTENDED)

    def diagonal(self):
        """Of J M^-1 J^T + C."""
        first, second = self.jacobian[:, 0], self.jacobian[:, 1]
        inverse = self.inverse_mass[self.bodies]
        same = (self.bodies[:, 0] == self.bodies[:, 1])[:, None]
        whole = np.where(same, first + second, first)
        rest = np.where(same, 0, second)
        return (np.einsum("mi,mij,mj->m", whole, inverse[:, 0], whole) +
                np.einsum("mi,mij,mj->m", rest, inverse[:, 1], rest) + self.compliance)

    def residuals(self, impulse):
        slack = self.along_rows(self.velocity(impulse)) + self.compliance * impulse - self.rhs
        diagonal = self.diagonal()
        moved = diagonal * abs(impulse - np.clip(impulse - slack / diagonal, self.lower, self.upper))
        endless = np.isinf(np.where(slack > 0, self.lower, self.upper))
        residuals = np.where(diagonal > 0, moved, np.where(endless, abs(slack), 0))  # the limit for a diagonal that goes to 0
        for rows, is_coulomb, mu in self.contacts:
            largest = np.max(np.where(diagonal > 0, diagonal, 1)[rows])
            residuals[rows] = _contact_residual(impulse[rows], slack[rows], largest, mu, is_coulomb)
        return residuals

    def rounding(self, impulse):
        """A bound of the terms that cancel, times the rounding of one of them."""
        gross = abs(self.jacobian) * abs(impulse[:, None, None])
        force = np.zeros_like(self.free_velocity)
        for side in (0, 1):
            held = self.bodies[:, side] >= 0
            np.add.at(force, self.bodies[held, side], gross[held, side])
        speed = abs(self.free_velocity) + np.einsum("nij,nj->ni", abs(self.inverse_mass), force)
        terms = sum((abs(self.jacobian[:, side]) * speed[self.bodies[:, side]]).sum(1) for side in (0, 1))
        return ROUNDING * np.max(terms + self.compliance * abs(impulse) + abs(self.rhs), initial=0)


def _contacts(file):
    """[(rows, whether Coulomb's law, mu)] of the contacts that have no box."""
    sets, normals = file["contact_set"][:], file["friction_row"][:]
    mu = file["friction_coefficient"][:].astype(EXTENDED)
    found = [(np.concatenate([[row], np.flatnonzero(normals == row)]), sets[row] == 2) for row in np.flatnonzero(sets)]
    return [(rows, is_coulomb, mu[rows[1]]) for rows, is_coulomb in found]


def _contact_residual(impulse, slack, diagonal, mu, is_coulomb):
    """d |lambda - P(lambda - w / d)|, P the projection on the cone."""
    slack = slack.copy()
    slack[0] += mu * np.sqrt(np.sum(slack[1:]**2)) if is_coulomb else 0
    point = impulse - slack / diagonal
    length = np.sqrt(np.sum(point[1:]**2))
    if length <= mu * point[0]:
        return abs(slack)
    if mu * length <= -point[0]:
        return diagonal * abs(impulse)
    normal = (point[0] + mu * length) / (1 + mu * mu)
    nearest = np.concatenate([[normal], mu * normal * point[1:] / length])
    return diagonal * abs(impulse - nearest)


def inverses(matrices):
    """Of symmetric positive definite matrices (n, k, k), by elimination: numpy's own knows 64 bits only."""
    size = matrices.shape[1]
    work = np.concatenate([matrices, np.broadcast_to(np.eye(size, dtype=EXTENDED), matrices.shape)], axis=2)
    for column in range(size):
        work[:, column] /= work[:, column, column][:, None].copy()
        for row in range(size):
            if row != column:
                work[:, row] -= work[:, row, column][:, None] * work[:, column]
    return work[:, :, size:]


def judge(problem, impulse, velocity=None):
    free = np.max(abs(problem.free_velocity), initial=0)
    limit = float(EXACT_LIMIT * max(1, free))
    impulse = np.asarray(impulse, EXTENDED)
    if not np.isfinite(impulse).all():
        return Verdict(np.inf, limit, 0.0, np.nan)
    error = np.nan if velocity is None else float(np.max(abs(problem.velocity(impulse) - velocity), initial=0))
    residual = np.max(problem.residuals(impulse), initial=0)
    return Verdict(float(residual), limit, float(problem.rounding(impulse)), error)


def judge_file(problem_path, solved_path):
    """{label: Verdict} of the solutions in one file, for the problem of another. Call it guarded."""
    with np.errstate(all="ignore"), h5py.File(problem_path) as problem_file, h5py.File(solved_path) as solved:
        problem = Problem(problem_file)
        return {label: judge(problem, group["impulse"][:], group["velocity"][:] if "velocity" in group else None)
                for label, group in solved.get("solution", {}).items()}
