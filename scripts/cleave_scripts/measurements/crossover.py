"""Where the exact solver overtakes those that iterate: rock piles along rows, mass ratio and compliance, all else the same."""
import dataclasses
import itertools
import math
from collections.abc import Callable

SCENE = "rock_pile"
BODIES, CFM = 200, 1e-6  # where they are not what changes
LIMITS = (1e-1, 1e-2, 1e-3, 1e-4, 1e-6)


@dataclasses.dataclass(frozen=True)
class Axis:
    """What changes along it, and which problems lie on it."""
    label: str
    title: str  # what stays the same
    of: Callable
    holds: Callable

    def problems(self, found):
        """In ascending order."""
        piles = (problem for problem in found if problem.scene == SCENE and not problem.is_settled)
        return sorted(filter(self.holds, piles), key=self.of)


AXES = (Axis("rows", f"mass ratio 1, cfm {CFM:g}", lambda problem: problem.rows,
             lambda problem: problem.mass_ratio == 1 and problem.cfm == CFM),
        Axis("mass ratio", f"{BODIES} bodies, cfm {CFM:g}", lambda problem: problem.mass_ratio,
             lambda problem: problem.bodies == BODIES and problem.cfm == CFM),
        Axis("cfm, s/kg", f"{BODIES} bodies, mass ratio 1", lambda problem: problem.cfm,
             lambda problem: problem.bodies == BODIES and problem.mass_ratio == 1))


def _crossing(before, after):
    """The value at which a ratio passes 1 between two (value, ratio), by straight lines in logarithms; a ratio that is infinite
    does so in the middle."""
    (low, first), (high, second) = before, after
    share = 0.5 if math.isinf(first) or math.isinf(second) else math.log(first) / (math.log(first) - math.log(second))
    return low * (high / low)**share


def exact_is_faster(points):
    """[(from, to)] of the values of an axis where a ratio is 1 or more; None: to the end. points: (value, ratio),
    ascending, one at least."""
    found, start = [], None
    for before, after in itertools.pairwise(points):
        if (before[1] >= 1) == (after[1] >= 1):
            continue
        crossing = _crossing(before, after)
        if before[1] >= 1:
            found.append((start, crossing))
        else:
            start = crossing
    if points[-1][1] >= 1:
        found.append((start, None))
    return found
