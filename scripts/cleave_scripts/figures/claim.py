"""A claim of the paper as a figure, computed alike from its Table 1 and from our rows.

A claim compares cells. A cell is (place, partitioner, refiner); a place is a scene, 'rocks 400' for a scaling run, or the
longest run of Log Tower. Its figure is a function of one number a cell: the mean of a column over the steps, or its peak.
"""
import dataclasses
import functools
import math

import numpy

HALF = 0.5  # a gain of stated size is reproduced by at least this share of it


@dataclasses.dataclass(frozen=True)
class Claim:
    """One row of the verdicts. figure maps value(cell) to the figure; it works on numbers and on arrays."""

    text: str  # the claim, equal for all its rows
    row: str  # which part of it
    baseline: str
    cells: tuple
    figure: object
    least: float = 0.0  # the figure has to lie in [least, most]
    most: float = math.inf
    share_of_paper: float = 0.0  # least is at least this share of the paper's own figure
    unit: str = "%"  # how to print: % as a share, x as a factor, or nothing
    column: str = "t_s_ms"
    statistic: str = "mean"  # over the steps: mean, peak (mean of the highest 5 %), most
    paper_cells: bool = True  # the paper's table has these cells
    sizes_decide: bool = True  # Mflop and interface rows decide where time cannot


def cell_name(cell):
    return f"{cell[1]} + {cell[2]}"


def gain(better, worse):
    return lambda value: 1 - value(better) / value(worse)


class LeastOf:
    """The least of several figures, which stay known one by one."""

    def __init__(self, parts):
        self.parts = tuple(parts)

    def __call__(self, value):
        return functools.reduce(numpy.minimum, [part(value) for part in self.parts])


def every_gain(better, worse):
    """The least gain of any of the better cells against any of the worse."""
    return LeastOf(gain(good, base) for good in better for base in worse)


def lowest(value, cells):
    return functools.reduce(numpy.minimum, [value(cell) for cell in cells])


def gain_of_lowest(better, worse):
    """Gain of the lowest of the better cells against the lowest of the worse."""
    return lambda value: 1 - lowest(value, better) / lowest(value, worse)


def exponent_difference(sizes, good, base):
    logs = numpy.log(numpy.array(sizes, float))
    weights = (logs - logs.mean()) / (
        (logs - logs.mean())**2).sum() if len(set(sizes)) > 1 else logs * math.nan

    def figure(value):
        return sum(
            weight * (numpy.log(value(b)) - numpy.log(value(g))) for weight, g, b in zip(weights, good, base))

    return figure
