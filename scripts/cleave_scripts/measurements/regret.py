"""What scripts/partition_regret measured: the partitioner auto against the best cell of a grid.

The time of a cell in a scene is the mean over its steps of the medians of t_pr_ms + t_s_ms over rounds. The best cell is the
one of least time in the odd rounds; what it is compared by are the even rounds, which it was not chosen by. Where auto chooses
the kernel too, its grid are the cells of all kernels, and the baseline is the best of theirs. Those were timed in several
replays of a round, of which one may be slower than another throughout: every replay has the cell WHOLE, and times are divided
by that of WHOLE in the same replay, round and step, and multiplied by its median over replays and rounds.
"""
import dataclasses
import statistics

from cleave_scripts.measurements.pace import paces_of, place
from cleave_scripts.results.rows import combination, has_parts, total_ms

AUTO, BASELINE = "auto+none", "mindp+none"
WHOLE = "pivot:monolithic"
ANY_KERNEL = "pivot:chosen"  # the solver of auto where it chooses among all kernels
MOST_REGRET = 0.1
COLUMNS = ("scene", "seed", "step", "solver", "partitioner", "refiner", "max_bodies", "calibration", "auto_choice", "threads",
           "round", "replay", "status", "t_pr_ms", "t_s_ms")


@dataclasses.dataclass
class Regret:
    scene: str
    solver: str
    best: str  # cell of the grid
    best_ms: float
    baseline_ms: float
    auto_ms: float
    choices: list  # of auto, in order of steps, each once

    @property
    def regret(self):
        return self.auto_ms / self.best_ms - 1

    @property
    def holds(self):
        return self.regret <= MOST_REGRET and self.auto_ms <= self.baseline_ms


def _times(rows, name, paces=None):
    """{name(row): [ms in the even rounds, in the odd ones]}"""
    lists = {}  # by cell, by parity, by step
    for row in rows:
        of_cell = lists.setdefault(name(row), ({}, {}))
        pace = paces[place(row)] if paces else 1
        of_cell[int(row["round"]) % 2].setdefault(row["step"], []).append(total_ms(row) / pace)
    return {cell: [statistics.fmean(map(statistics.median, steps.values())) for steps in of_cell]
            for cell, of_cell in lists.items()}


def _cell_and_kernel(row):
    kernel = row["solver"].partition(":")[2]
    return f"{combination(row)}/{kernel}" if has_parts(row) else kernel


def _best(times, cells):
    return min(cells, key=lambda cell: times[cell][1])


def _regret(scene, solver, rows):
    """rows: of the scene."""
    chooses_kernel = solver == ANY_KERNEL
    paces = paces_of(rows, lambda row: row["solver"] == WHOLE) if chooses_kernel else None
    auto = [row for row in rows if row["solver"] == solver and combination(row) == AUTO]
    grid = _times([row for row in rows if row["partitioner"] != "auto" and (chooses_kernel or row["solver"] == solver)],
                  _cell_and_kernel if chooses_kernel else combination, paces)
    best, baseline = _best(grid, grid), _best(grid, [cell for cell in grid if cell.split("/")[0] == BASELINE])
    (auto_times,) = _times(auto, combination, paces).values()
    choices = dict.fromkeys(row["auto_choice"] for row in auto)
    return Regret(scene, solver, best, grid[best][0], grid[baseline][0], auto_times[0], list(choices))


def regrets(rows):
    """[Regret], one a scene and solver with rows of AUTO. rows: with a round, of two rounds or more; BASELINE among them."""
    scenes = {}
    for row in rows:
        scenes.setdefault(row["scene"], []).append(row)
    return [_regret(scene, solver, of_scene) for scene, of_scene in scenes.items()
            for solver in dict.fromkeys(row["solver"] for row in of_scene if combination(row) == AUTO)]
