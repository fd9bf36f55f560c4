"""Medians of what scripts/two_threads and scripts/busy_machine measured.

Two threads are held against what two independent solves on one thread each reach side by side in the same run: the
ceiling, 2 on an ideal machine, less where cores share caches, memory or a clock. Rounds of two threads on cores far apart
say more of where a virtual machine was put, and are left out.
"""
import dataclasses
import math
import statistics

from cleave_scripts.measurements.side_by_side import WAYS
from cleave_scripts.results.errors import ResultError
from cleave_scripts.results.names import base_name, said_parameters
from cleave_scripts.results.rows import is_far
from cleave_scripts.table import text

LEAST_CEILING = 1.7  # below it a share says more of the machine
ASKED_SHARE = 0.8  # of `schur` on every combination
ASKED_OF_SWEEPS = {"pgs-colored": 0.75}  # least share of a solver that iterates
KEY = ("scene", "bodies", "cfm", "step", "solver", "partitioner", "refiner")


@dataclasses.dataclass(frozen=True)
class Share:
    """Of a recorded step, solver and combination; times are medians over the rounds, of two threads over those on cores near
    each other."""
    scene: str
    bodies: int
    cfm: float
    step: int
    solver: str
    combination: str
    one_ms: float  # one thread alone
    two_ms: float  # two threads; NaN where no round of them counts
    beside_ms: float  # one thread beside another
    far_rounds: int  # of two threads, left out
    rounds: int

    @property
    def ratio(self):
        return self.one_ms / self.two_ms

    @property
    def ceiling(self):
        return 2 * self.one_ms / self.beside_ms

    @property
    def share(self):
        return self.ratio / self.ceiling

    @property
    def measured(self):
        return self.ceiling >= LEAST_CEILING and self.far_rounds < self.rounds


def _medians(rows, *columns):
    """{values of the columns: median t_s in ms}"""
    times = {}
    for row in rows:
        times.setdefault(tuple(str(row[column]) for column in columns), []).append(float(row["t_s_ms"]))
    return {key: statistics.median(values) for key, values in times.items()}


def shares(rows):
    """[Share], in the order of the rows"""
    of_cell = {}
    for row in rows:
        of_cell.setdefault(tuple(str(row[column]) for column in KEY), []).append(row)
    return [_share(key, rows_of_cell) for key, rows_of_cell in of_cell.items()]


def _share(key, rows):
    scene, bodies, cfm, step, solver, partitioner, refiner = key
    times = _medians([row for row in rows if not is_far(row)], "threads", "processes")
    ways = [(str(way.threads), str(way.processes)) for way in WAYS]
    far, rounds = sum(map(is_far, rows)), sum(str(row["threads"]) == "2" for row in rows)
    if far > 0:
        times.setdefault(("2", "1"), math.nan)
    if not all(way in times for way in ways):
        raise ResultError(f"two threads: {' '.join(key)} is not there with {', '.join(way.name for way in WAYS)}")
    return Share(scene, int(bodies), float(cfm), int(step), solver, f"{partitioner}+{refiner}",
                 *(times[way] for way in ways), far, rounds)


def of_scene(found, scene):
    return [share for share in found if share.scene == scene]


def large_rock_pile(found):
    """Its [Share] of `schur`, and those of solvers that iterate a number of times, whatever their residual."""
    large = of_scene(found, "large_rock_pile")
    return [[share for share in large if ("sweeps" in said_parameters(share.solver)) == iterates] for iterates in (False, True)]


def by_step(found):
    """{step: [Share]}"""
    return {step: [share for share in found if share.step == step] for step in sorted({share.step for share in found})}


def least(found):
    """The least share that is measured; where none is, that of the highest ceiling."""
    return min((share for share in found if share.measured), key=lambda share: share.share,
               default=max(found, key=lambda share: share.ceiling))


COUNTED = (f"below {ASKED_SHARE}", "measured", "combinations")


@dataclasses.dataclass(frozen=True)
class Counts:
    """Of the shares of one step, as COUNTED."""
    below: int  # measured, and less than was asked
    measured: int
    combinations: int


def counts(found):
    measured = [share for share in found if share.measured]
    return Counts(sum(share.share < ASKED_SHARE for share in measured), len(measured), len(found))


def verdict(found):
    """'0.75, holds': what was asked of every step of one solver, and whether it holds; '-' where nothing was asked."""
    asked = ASKED_OF_SWEEPS.get(base_name(found[0].solver))
    if asked is None:
        return "-"
    worst = least(found)
    return f"{asked}, " + ("not measured" if not worst.measured else text.holds(worst.share >= asked))


def _told(share):
    if share.measured:
        return f"{share.share:.2f}"
    return "not measured: " + ("cores far apart" if share.far_rounds == share.rounds else f"ceiling below {LEAST_CEILING}")


def far_in_words(found):
    """Of shares, or nothing."""
    far, rounds = sum(share.far_rounds for share in found), sum(share.rounds for share in found)
    return f"{far} of {rounds} replays on two threads were on cores far apart and do not count" if far > 0 else ""


def _cells(share):
    told = _told(share)
    return [text.number(share.one_ms), text.two_decimals(share.ratio), f"{share.ceiling:.2f}", told]


def lines_of_shares(found):
    """A table of the rock piles, one of Large Rock Pile, where the least of the combinations is shown,
    and one of solvers that iterate there."""
    times = ("one thread, ms", "ratio", "ceiling")
    piles = [[share.bodies, f"{share.cfm:g}", share.solver, *_cells(share)] for share in of_scene(found, "rock_pile")]
    direct, sweeps = large_rock_pile(found)
    large = [[step, least(of_step).combination, *_cells(least(of_step)), *dataclasses.astuple(counts(of_step))]
             for step, of_step in by_step(direct).items()]
    tables = [text.table(("rocks", "cfm", "solver", *times, "share"), piles),
              text.table(("Large Rock Pile, step", "combination", *times, "least share", *COUNTED), large)]
    if sweeps:
        lines = [[share.step, share.solver, *_cells(share)] for share in sweeps]
        tables.append(text.table(("Large Rock Pile, step", "solver", *times, "share"), lines))
    return "\n\n".join(filter(None, [*tables, far_in_words(found)]))


def by_load(rows):
    """{busy loops: t_s in ms}, fewest loops first"""
    return {int(loops): time for (loops,), time in sorted(_medians(rows, "busy_loops").items())}


def sleeping_over_awake(rows):
    """{scene: t_s with threads that go to sleep over t_s with threads that never do},
    medians over the rounds of scripts/idle_cost"""
    ratios = {}
    for row in rows:
        ratios.setdefault(row["scene"], []).append(float(row["t_s_ms"]) / float(row["awake_t_s_ms"]))
    return {scene: statistics.median(of_scene) for scene, of_scene in ratios.items()}
