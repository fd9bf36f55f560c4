"""What scripts/partition_regret measured: the partitioner auto against the best cell of a grid.

The time of a cell in a scene and round is the mean of t_pr_ms + t_s_ms over its steps. The best cell is the one of least
median over the odd rounds; what it is compared by are the even rounds, which it was not chosen by.
"""
import dataclasses
import statistics

AUTO, BASELINE = "auto+none", "mindp+none"
MOST_REGRET = 0.1
COLUMNS = ("scene", "seed", "step", "solver", "partitioner", "refiner", "max_bodies", "calibration", "auto_choice", "threads",
           "round", "status", "t_pr_ms", "t_s_ms")


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


def cell_of(row):
    return f"{row['partitioner']}+{row['refiner']}"


def _times(rows):
    """{cell: {round: mean ms}}"""
    lists = {}
    for row in rows:
        total = float(row["t_pr_ms"]) + float(row["t_s_ms"])
        lists.setdefault(cell_of(row), {}).setdefault(int(row["round"]), []).append(total)
    return {cell: {number: statistics.fmean(times) for number, times in rounds.items()} for cell, rounds in lists.items()}


def _median(rounds, parity):
    return statistics.median(ms for number, ms in rounds.items() if number % 2 == parity)


def _regret(scene, solver, rows):
    times = _times(rows)
    grid = [cell for cell in times if not cell.startswith("auto+")]
    best = min(grid, key=lambda cell: _median(times[cell], 1))
    best_ms, baseline_ms, auto_ms = (_median(times[cell], 0) for cell in (best, BASELINE, AUTO))
    choices = dict.fromkeys(row["auto_choice"] for row in rows if cell_of(row) == AUTO)
    return Regret(scene, solver, best, best_ms, baseline_ms, auto_ms, list(choices))


def regrets(rows):
    """[Regret], one a scene and solver. rows: with a round, of two rounds or more, each with AUTO and BASELINE."""
    groups = {}
    for row in rows:
        groups.setdefault((row["scene"], row["solver"]), []).append(row)
    return [_regret(scene, solver, of_scene) for (scene, solver), of_scene in groups.items()]
