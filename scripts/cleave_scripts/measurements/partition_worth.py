"""What scripts/partition_worth measured: when a partition pays.

The time of a cell is t_pr + t_s: on one thread and on two as measured, on more workers as modelled from the one-thread solve. Of
every solver the fastest partition counts, for each number of workers anew. Speed-ups are against the fastest solver on one
thread. Where a scene names groups of bodies, parts after them are held against those that are found.
"""
import dataclasses

from cleave_scripts.results.names import base_name
from cleave_scripts.results.rows import combination, has_parts, split_ms, total_ms

KEY = ("scene", "bodies", "cfm")
MODELLED = (2, 4, 8, 16, 32, 64)
WORKERS = (1, *MODELLED)
SEMANTIC = "semantic"
WHOLE, RUNS, FOUND = "groups", "groups in runs", "found"  # kinds of partitions
NAMES = {"auto:schur-rows": "schur-rows, the paper's", "auto:schur-bodies": "schur-bodies", "auto:schur-nested": "schur-nested",
         "auto:monolithic": "whole system"}


@dataclasses.dataclass(frozen=True)
class Cell:
    time_ms: float
    partition: str  # "-" for the whole system


@dataclasses.dataclass(frozen=True)
class Problem:
    key: tuple  # values of KEY
    rows: int
    best: dict  # {(solver, workers): Cell}, workers as modelled but for 1
    measured: dict  # {solver: Cell} on two threads

    @property
    def base_ms(self):
        return min(cell.time_ms for (_, workers), cell in self.best.items() if workers == 1)

    def speed_up(self, solver, workers):
        return self.base_ms / self.best[solver, workers].time_ms

    def winner(self, workers):
        return min((solver for solver, count in self.best if count == workers), key=lambda solver: self.best[solver, workers].time_ms)


def _least(cells, key, cell):
    if key not in cells or cell.time_ms < cells[key].time_ms:
        cells[key] = cell


def problems(rows):
    """[Problem], by rows."""
    found = {}
    for row in rows:
        best, measured, count = found.setdefault(tuple(row[name] for name in KEY), ({}, {}, int(row["rows"])))[:3]
        if int(row["threads"]) == 2:
            _least(measured, row["solver"], Cell(total_ms(row), combination(row)))
            continue
        _least(best, (row["solver"], 1), Cell(total_ms(row), combination(row)))
        for workers in MODELLED:
            _least(best, (row["solver"], workers), Cell(split_ms(row) + float(row[f"t_s_model_p{workers}_ms"]), combination(row)))
    return sorted((Problem(key, count, best, measured) for key, (best, measured, count) in found.items()),
                  key=lambda problem: (problem.key[0], problem.rows, float(problem.key[2])))


@dataclasses.dataclass(frozen=True)
class Kind:
    """The fastest partition of a kind."""
    cell: Cell
    parts: int
    interface_rows: int


def _kind(row):
    if base_name(row["partitioner"]) != SEMANTIC:
        return FOUND
    return WHOLE if "split=whole" in row["partitioner"] else RUNS


def kinds(rows):
    """{(key, rows, solver): {kind: Kind}} on one thread, of the problems that name groups."""
    found = {}
    for row in rows:
        if int(row["threads"]) != 1 or not has_parts(row):
            continue
        of_kind = found.setdefault((tuple(row[name] for name in KEY), int(row["rows"]), row["solver"]), {})
        kind = Kind(Cell(total_ms(row), combination(row)), int(row["parts"]), int(row["interface_rows"]))
        if _kind(row) not in of_kind or kind.cell.time_ms < of_kind[_kind(row)].cell.time_ms:
            of_kind[_kind(row)] = kind
    return {key: of_kind for key, of_kind in found.items() if WHOLE in of_kind}
