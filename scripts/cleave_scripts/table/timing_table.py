"""Mean times of every combination of every scene, beside the paper's: the numbers of Table 1.

t_s solves, t_pr partitions and refines, both in ms; total = t_s + t_pr.
"""
import dataclasses
import math

from cleave_scripts.results.errors import ResultError
from cleave_scripts.results.paper import PARTITIONERS, REFINERS, SCENES
from cleave_scripts.results.steps import NO_PARTITIONER

NEEDED = ("scene", "seed", "step", "partitioner", "refiner", "solver", "threads", "status", "t_s_ms",
          "t_pr_ms")
# A mean over rows that differ in one of these would mean nothing.
SAME_IN_A_SCENE = ("solver", "threads", "friction", "max_bodies", "tau_mr", "tau_mix", "max_growth", "dt_s",
                   "mu", "cfm", "erp", "gravity_m_per_s2", "friction_force_n", "match_tolerance",
                   "contact_cap", "edge_weight", "degree", "degree_scope", "as_printed", "skip_small_islands",
                   "cold")
# Nor over rows of a solver with other options.
SAME_SOLVER = ("predictor_sweeps", "max_iterations", "reuse_analysis")
# Nor over rows of other problems: another scene, or steps of a world that moved otherwise.
SAME_WORLD = ("scene_options", "mode", "advance", "steps")
UNKNOWN = "unknown"  # the value of a column that a file does not have
# What else is looked at where it is there.
READ_TOO = ("bodies", "t_s_waiting_ms")
# The paper's runs: bodies of each scene, and steps of all.
PAPER_BODIES = {"chain_drop": 100, "log_tower": 201, "rock_pile": 200, "large_rock_pile": 600}
PAPER_STEPS = 500
MOST_WAITING = 0.05  # of t_s, for a core; above it a mean says more of the machine's other work


@dataclasses.dataclass
class Times:
    """One pair of times in ms; nan where there is none."""

    t_s_ms: float = math.nan
    t_pr_ms: float = math.nan

    @property
    def total_ms(self):
        return self.t_s_ms + self.t_pr_ms

    def __truediv__(self, other):
        """Ratios of t_s, t_pr and total; nan where one side is missing."""
        ours = (self.t_s_ms, self.t_pr_ms, self.total_ms)
        theirs = (other.t_s_ms, other.t_pr_ms, other.total_ms)
        return [a / b if b > 0 else math.nan for a, b in zip(ours, theirs)]


@dataclasses.dataclass
class Cell:
    partitioner: str
    refiner: str
    ours: Times = dataclasses.field(default_factory=Times)
    paper: Times = dataclasses.field(default_factory=Times)
    ok: int = 0  # measured steps that ours is the mean of
    failed: int = 0  # rows with another status; not in the mean
    missing: int = 0  # steps of the scene without a row of this combination
    waiting: float = math.nan  # share of t_s in which threads waited for a core; nan where unknown
    ours_lowest: bool = False
    paper_lowest: bool = False

    @property
    def complete(self):
        return self.ok > 0 and self.failed == 0 and self.missing == 0

    @property
    def waited(self):
        return self.waiting > MOST_WAITING

    @property
    def remark(self):
        parts = [
            f"{count} of {self.ok + self.failed + self.missing} steps {what}"
            for count, what in ((self.failed, "failed"), (self.missing, "missing"))
            if count
        ]
        return ", ".join(parts)


@dataclasses.dataclass
class SceneTable:
    scene: str
    steps: int  # measured
    threads: str
    solver: str
    cells: list  # Cell, in the paper's order
    differs: str = ""  # how the runs differ from the paper's in size; empty where they do not

    @property
    def title(self):
        return self.scene.replace("_", " ").title()


def build_tables(rows, paper, where=()):
    """One SceneTable a scene that has rows. where: (column, value) pairs a row must have."""
    by_scene = {}
    for row in rows:
        if row["partitioner"] != NO_PARTITIONER and all(
                _value(row, column) == value for column, value in where):
            by_scene.setdefault(row["scene"], []).append(row)
    if not by_scene:
        raise ResultError("no measured rows of a partitioned solver" +
                          (" that --where allows" if where else ""))
    return [_scene_table(scene, by_scene[scene], paper) for scene in _in_order(by_scene, SCENES)]


def _value(row, column):
    if column not in row:
        raise ResultError(f"{row.path}: no column {column}")
    return row[column]


def _scene_table(scene, rows, paper):
    for column in (*SAME_IN_A_SCENE, *SAME_SOLVER, *SAME_WORLD):
        values = sorted({row.get(column, UNKNOWN) for row in rows}, key=lambda value: (value == UNKNOWN, value))
        if len(values) > 1:
            raise ResultError(f"rows of {scene} mix {column} {', '.join(values)}; "
                              f"choose one with --where {column}={values[0]}")
    steps = {(row["seed"], row["step"]) for row in rows}
    groups = {(partitioner, refiner): [] for partitioner in PARTITIONERS for refiner in REFINERS}
    seen = {}
    for row in rows:
        key = (row["seed"], row["step"], row["partitioner"], row["refiner"])
        if key in seen:
            raise ResultError(
                f"{row.path}, line {row.line}: step {row['step']} of {scene}, {row['partitioner']} "
                f"{row['refiner']} stands already in {seen[key].path}, line {seen[key].line}")
        seen[key] = row
        groups.setdefault(key[2:], []).append(row)
    cells = [_cell(scene, names, groups[names], len(steps), paper) for names in groups]
    _mark_lowest([cell for cell in cells if cell.complete], "ours")
    _mark_lowest(cells, "paper")
    return SceneTable(scene, len(steps), rows[0]["threads"], rows[0]["solver"], cells,
                      _differences(scene, rows))


def _differences(scene, rows):
    """'60 steps (paper 500), 12 bodies (paper 200)'; empty for a scene that the paper does not have."""
    if scene not in PAPER_BODIES:
        return ""
    wanted = (("steps", PAPER_STEPS), ("bodies", PAPER_BODIES[scene]))
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


def _mark_lowest(cells, which):
    totals = [getattr(cell, which).total_ms for cell in cells]
    for cell, total in zip(cells, totals):
        if not math.isnan(total) and total == min(value for value in totals if not math.isnan(value)):
            setattr(cell, which + "_lowest", True)


def _in_order(names, known):
    return [name for name in known if name in names] + sorted(name for name in names if name not in known)
