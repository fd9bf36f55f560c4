"""What the paper leaves open, and under which choice the cells are ordered as its Table 1 orders them.

A setting says how bodies are numbered, how many a part may have, whether bfs begins anew for every part, and the thresholds of
mr and mix. Its 15 combinations are taken from the cells of the campaign `hidden-choices`, all scenes alike. The cut, in
interface rows, is known of every setting; times of those whose cells were solved by the paper's solver with repeats.
"""
import dataclasses
import itertools

import pandas

from cleave_scripts.results.errors import ResultError
from cleave_scripts.results.paper import COMBINATIONS, PAPER, SCENES

BFS, MR, MIX = (("bfs", "bfs@restart=graph"), ("mr", "mr@tau-mr=10.5", "mr@tau-mr=101"),
                ("mix@tau-mix=0.25", "mix", "mix@tau-mix=0.75"))
CUT, TIME = "cut", "time"
CELL = ("scene", "logs", "max_bodies", "body_order", "solver")
MEANS = ("interface_rows", "parts", "t_s_ms", "t_pr_ms")
MOST = ("max_part_bodies", "part_mass_ratio_max", "part_condition_max")
COLUMNS = (*CELL, "partitioner", "refiner", "steps", *MEANS, *MOST)
TIMES = ("t_s_ms", "t_s_min_ms", "t_pr_ms")
PAPERS_LOGS = 5  # a layer of Log Tower
DEFAULT_SIZE = 25  # of parts, by the program's default


@dataclasses.dataclass(frozen=True)
class Setting:
    max_bodies: int
    body_order: str
    bfs: str
    mr: str
    mix: str

    @property
    def is_default(self):
        return self == DEFAULT

    def name_of(self, partitioner):
        """What the cells of the campaign call one of the paper's partitioners."""
        return getattr(self, partitioner, partitioner)

    @property
    def order(self):
        return self.body_order.partition("@")[0]


DEFAULT = Setting(DEFAULT_SIZE, "scene", "bfs", "mr", "mix")  # of the program


def settings(table):
    """Those that the table of means has cells of, for every scene."""
    mine = table[(table["scene"] != "log_tower") | (table["logs"] == PAPERS_LOGS)]
    there = mine.groupby(["max_bodies", "body_order"])["scene"].nunique()
    return [Setting(*cell, *names) for cell in there[there == len(SCENES)].index for names in itertools.product(BFS, MR, MIX)]


def rows_of(experiments):
    """All rows of the campaign's cells in one frame, with the logs a layer has."""
    frames = []
    for experiment in experiments:
        logs = experiment.manifest.get("options", {}).get("logs", PAPERS_LOGS)
        frames.append(experiment.rows.assign(logs=int(logs)))
    rows = pandas.concat(frames, ignore_index=True)
    missing = [column for column in (*CELL, *MEANS, *MOST) if column not in rows]
    if missing:
        raise ResultError(f"the cells have no column {', '.join(missing)}")
    failed = rows[rows["status"] != "ok"]
    if len(failed):
        raise ResultError(f"{len(failed)} rows of the campaign are not ok, such as cell {failed['run_id'].iloc[0]}")
    return rows.assign(max_bodies=_said_or_own(rows))


def _said_or_own(rows):
    """Parts of which the cell has the bound: partitioners that have none of their own all take it."""
    return rows.groupby("run_id")["max_bodies"].transform("max").astype(int)


def means(rows):
    """A row a cell and combination: COLUMNS."""
    groups = rows.groupby([*CELL, "partitioner", "refiner"], sort=False)
    table = groups.agg(steps=("step", "count"), **{name: (name, "mean") for name in MEANS},
                       **{name: (name, "max") for name in MOST})
    return table.reset_index()[list(COLUMNS)]


def cells_of(table, setting, solver):
    """{scene: rows}"""
    mine = table[(table["max_bodies"] == setting.max_bodies) & (table["body_order"] == setting.body_order) &
                 (table["solver"] == solver)]
    return {scene: mine[(mine["scene"] == scene) & ((scene != "log_tower") | (mine["logs"] == PAPERS_LOGS))]
            for scene in SCENES}


class Settings:
    """The 15 combinations of every setting, by cut and by time."""

    def __init__(self, table):
        self.all = settings(table)
        others = sorted(set(table["solver"]) - {PAPER["solver"]})
        if len(others) != 1:
            raise ResultError(f"the campaign needs {PAPER['solver']} and one other solver, for the cuts; it has "
                              f"{', '.join(others) or 'none'}")
        self.cut_solver, = others
        self._lookup = {}
        for row in table.itertuples():
            if row.scene != "log_tower" or row.logs == PAPERS_LOGS:
                self._lookup[row.solver, row.scene, row.max_bodies, row.body_order, row.partitioner, row.refiner] = row
        timed = table[table["solver"] == PAPER["solver"]]
        self.timed = [setting for setting in self.all
                      if not timed[(timed["max_bodies"] == setting.max_bodies) &
                                   (timed["body_order"] == setting.body_order)].empty]

    def row(self, setting, cell, by):
        """Of the table of means; cell: (scene, partitioner, refiner) of the paper."""
        solver = PAPER["solver"] if by == TIME else self.cut_solver
        scene, partitioner, refiner = cell
        names = scene, setting.max_bodies, setting.body_order, setting.name_of(partitioner), refiner
        if (solver, *names) not in self._lookup:
            raise ResultError(f"the campaign has no cell of {', '.join(map(str, names))} by {solver}")
        return self._lookup[solver, *names]

    def value(self, setting, cell, by):
        return self.row(setting, cell, by).t_s_ms if by == TIME else self.row(setting, cell, by).interface_rows


def fit(found, setting, by, paper):
    """{scene: Spearman's rank correlation of its 15 cells with the paper's t_s}"""
    result = {}
    for scene in SCENES:
        cells = [(scene, *names) for names in COMBINATIONS]
        ours = pandas.Series([found.value(setting, cell, by) for cell in cells]).rank()
        theirs = pandas.Series([paper[cell][0] for cell in cells]).rank()
        result[scene] = float(ours.corr(theirs)) if ours.nunique() > 1 else 0.0
    return result


def fits(found, paper):
    """A row a setting, by cut and, where there are times, by time; the best first."""
    rows = []
    for by, which in ((CUT, found.all), (TIME, found.timed)):
        for setting in which:
            scenes = fit(found, setting, by, paper)
            rows.append({"by": by, **dataclasses.asdict(setting), "mean": sum(scenes.values()) / len(scenes), **scenes})
    return pandas.DataFrame(rows).sort_values(["by", "mean"], ascending=[False, False], kind="stable")
