"""Mean times of every combination of every scene, beside the paper's: the numbers of Table 1.

t_s solves, t_pr partitions and refines, both in ms; total = t_s + t_pr.
"""
import itertools
import math

from cleave_scripts.results.about import setup_columns
from cleave_scripts.results.errors import ResultError
from cleave_scripts.results.names import NO_PARTITIONER, in_order, said_parameters
from cleave_scripts.results.paper import PAPER, PARTITIONERS, REFINERS, SCENES
from cleave_scripts.results.rows import is_far
from cleave_scripts.table.cells import Cell, SceneTable, Times

NEEDED = ("scene", "seed", "step", "partitioner", "refiner", "solver", "threads", "status", "t_s_ms",
          "t_pr_ms")
SAME_RUN = ("solver", "threads", "steps", "machine")  # besides what the setup is; the last from the manifest
NOT_A_PARAMETER = "-"  # the value of a column that does not apply to a row
UNKNOWN = "unknown"  # the value of a column that a file does not have
# What else is looked at where it is there.
READ_TOO = ("bodies", "t_s_waiting_ms", "core_round_trip_ns")


def build_tables(rows, paper, where=(), setup=setup_columns()):
    """One SceneTable a scene that has rows. where: (column, value) pairs a row must have; setup: columns in which rows of a
    scene must not differ, where their names do not say why."""
    by_scene = {}
    for row in rows:
        if row["partitioner"] != NO_PARTITIONER and all(
                _value(row, column) == value for column, value in where):
            by_scene.setdefault(row["scene"], []).append(row)
    if not by_scene:
        raise ResultError("no measured rows of a partitioned solver" +
                          (" that --where allows" if where else ""))
    return [_scene_table(scene, by_scene[scene], paper, setup) for scene in in_order(by_scene, SCENES)]


def _value(row, column):
    if column not in row:
        raise ResultError(f"{row.path}: no column {column}")
    return row[column]


def _scene_table(scene, rows, paper, setup):
    for column in (*SAME_RUN, *setup):
        _check_same(scene, rows, column)
    steps = {(row["seed"], row["step"]) for row in rows}
    cells = [_cell(scene, names, mine, len(steps), paper) for names, mine in _by_combination(rows).items()]
    mark_lowest(scene, cells, paper)
    first = rows[0]
    return SceneTable(scene, len(steps), first["threads"], first["solver"], cells, _differences(scene, rows), far_share(rows))


def _check_same(scene, rows, column):
    """A mean over rows that differ in a column of the setup would mean nothing."""
    values = {_setup_value(row, column) for row in rows} - {None}
    values = sorted(values, key=lambda value: (value == UNKNOWN, value))
    if len(values) > 1:
        raise ResultError(f"rows of {scene} mix {column} {', '.join(values)}; "
                          f"choose one with --where {column}={values[0]}")


def _setup_value(row, column):
    """None where the row's names say the value, or its algorithms have no such parameter."""
    said = said_parameters(row["partitioner"]) | said_parameters(row["refiner"])
    value = row.get(column, UNKNOWN)
    return None if value == NOT_A_PARAMETER or column.replace("_", "-") in said else value


def _by_combination(rows):
    """{(partitioner, refiner): rows}, the paper's names first, the others as they come."""
    groups, seen = {}, {}
    for row in rows:
        key = (row["seed"], row["step"], row["partitioner"], row["refiner"])
        if key in seen:
            raise ResultError(
                f"{row.path}, line {row.line}: step {row['step']} of {row['scene']}, {row['partitioner']} "
                f"{row['refiner']} stands already in {seen[key].path}, line {seen[key].line}")
        seen[key] = row
        groups.setdefault(key[2:], []).append(row)
    partitioners = in_order((names[0] for names in groups), PARTITIONERS)
    refiners = in_order((names[1] for names in groups), REFINERS)
    return {names: groups[names] for names in itertools.product(partitioners, refiners) if names in groups}


def _differences(scene, rows):
    """'60 steps (paper 500), 12 bodies (paper 200)'; empty for a scene that the paper does not have."""
    if scene not in SCENES:
        return ""
    wanted = (("steps", PAPER["steps"]), ("bodies", PAPER["bodies"][scene]))
    parts = []
    for column, paper in wanted:
        values = {row.get(column, UNKNOWN) for row in rows}
        if values != {str(paper)}:
            parts.append(f"{' and '.join(sorted(values))} {column} (paper {paper})")
    return ", ".join(parts)


def _cell(scene, names, rows, steps, paper):
    cell = Cell(*names, failed=sum(row["status"] != "ok" for row in rows), missing=steps - len(rows))
    measured = [row for row in rows if row["status"] == "ok"]
    cell.ok = len(measured)
    if measured:
        cell.ours = Times(_mean(measured, "t_s_ms"), _mean(measured, "t_pr_ms"))
        cell.waiting = waiting_share(measured)
    if (scene, *names) in paper:
        cell.paper = Times(*paper[(scene, *names)])
    return cell


def _mean(rows, column):
    for row in rows:
        if not math.isfinite(row.number(column)):
            raise ResultError(f"{row.path}, line {row.line}: status ok, but {column} is '{row[column]}'")
    return math.fsum(row.number(column) for row in rows) / len(rows)


def waiting_share(rows):
    """Time in which threads waited for a core over t_s; nan where no row knows it."""
    known = [row for row in rows if "t_s_waiting_ms" in row and math.isfinite(row.number("t_s_waiting_ms"))]
    total = math.fsum(row.number("t_s_ms") for row in known)
    return math.fsum(row.number("t_s_waiting_ms") for row in known) / total if total > 0 else math.nan


def far_share(rows):
    """Of the time of all solves, that of those on cores far apart."""
    measured = [row for row in rows if row["status"] == "ok"]
    total = math.fsum(row.number("t_s_ms") for row in measured)
    return math.fsum(row.number("t_s_ms") for row in measured if is_far(row)) / total if total > 0 else 0.0


def mark_lowest(scene, cells, paper):
    """The lowest total of the complete cells, and of all that the paper has of the scene."""
    least = min((cell.ours.total_ms for cell in cells if cell.complete), default=math.nan)
    least_of_paper = min((sum(paper[key]) for key in paper if key[0] == scene), default=math.nan)
    for cell in cells:
        cell.ours_lowest = cell.complete and cell.ours.total_ms == least
        cell.paper_lowest = cell.paper.total_ms == least_of_paper
