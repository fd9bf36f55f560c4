"""What scripts/karger measured: how many trials of random contraction it takes to cut as little as mindp + fm, and what that
costs."""
import dataclasses
import math
import statistics

TRIALS = (1, 10, 100, 1000, 10000)
BISECTION = "recursive-bisection"  # karger_method, tried once
RIVALS = (("mindp", "fm"), ("mix", "fm"))
GOAL = RIVALS[0]
REFINERS = ("none", "fm")


@dataclasses.dataclass(frozen=True)
class Cell:
    """Means over the steps of a scene."""
    rows: float  # interface rows
    t_pr_ms: float
    total_ms: float  # t_pr + t_s


def _kind(row):
    if row["trials"] == "-":
        return row["partitioner"]
    return BISECTION if row["karger_method"] == BISECTION else int(row["trials"])


def cells_of(rows, scene):
    """{(partitioner, number of trials or BISECTION, refiner): Cell}"""
    found = {}
    for row in rows:
        if row["scene"] == scene:
            found.setdefault((_kind(row), row["refiner"]), []).append(row)

    def mean(steps, *columns):
        return statistics.fmean(sum(float(step[column]) for column in columns) for step in steps)

    return {key: Cell(mean(steps, "interface_rows"), mean(steps, "t_pr_ms"), mean(steps, "t_pr_ms", "t_s_ms"))
            for key, steps in found.items()}


def trials_needed(cells, refiner):
    """The least number of trials that cuts no more rows than GOAL on the mean; infinite where none of them does."""
    return next((trials for trials in TRIALS if cells[trials, refiner].rows <= cells[GOAL].rows), math.inf)


def lowest_totals(cells):
    """(of the rivals, of karger), ms"""
    return (min(cells[rival].total_ms for rival in RIVALS),
            min(cells[trials, refiner].total_ms for trials in TRIALS for refiner in REFINERS))
