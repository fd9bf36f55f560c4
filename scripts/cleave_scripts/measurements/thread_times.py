"""Medians of what scripts/two_threads and scripts/busy_machine measured.

Two threads are held against what two independent solves on one thread each reach side by side in the same run: the
ceiling, 2 on an ideal machine, less where cores share caches, memory or a clock.
"""
import dataclasses
import statistics

from cleave_scripts.measurements.side_by_side import WAYS
from cleave_scripts.results.errors import ResultError
from cleave_scripts.table import text

LEAST_CEILING = 1.7  # below it a share says more of the machine
KEY = ("scene", "bodies", "cfm", "step", "solver", "partitioner", "refiner")


@dataclasses.dataclass(frozen=True)
class Share:
    """Of a recorded step, solver and combination; times are medians over the rounds."""
    scene: str
    bodies: int
    cfm: float
    step: int
    solver: str
    combination: str
    one_ms: float  # one thread alone
    two_ms: float  # two threads
    beside_ms: float  # one thread beside another

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
        return self.ceiling >= LEAST_CEILING


def _medians(rows, *columns):
    """{values of the columns: median t_s in ms}"""
    times = {}
    for row in rows:
        times.setdefault(tuple(str(row[column]) for column in columns), []).append(float(row["t_s_ms"]))
    return {key: statistics.median(values) for key, values in times.items()}


def shares(rows):
    """[Share], in the order of the rows"""
    times = _medians(rows, *KEY, "threads", "processes")
    return [_share(key, times) for key in dict.fromkeys(key[:len(KEY)] for key in times)]


def _share(key, times):
    scene, bodies, cfm, step, solver, partitioner, refiner = key
    try:
        in_ms = [times[*key, str(way.threads), str(way.processes)] for way in WAYS]
    except KeyError:
        raise ResultError(f"two threads: {' '.join(key)} is not there with {', '.join(way.name for way in WAYS)}") from None
    return Share(scene, int(bodies), float(cfm), int(step), solver, f"{partitioner}+{refiner}", *in_ms)


def of_scene(found, scene):
    return [share for share in found if share.scene == scene]


def by_step(found):
    """{step: [Share]}"""
    return {step: [share for share in found if share.step == step] for step in sorted({share.step for share in found})}


def least(found):
    """The least share that is measured; where none is, that of the highest ceiling."""
    return min((share for share in found if share.measured), key=lambda share: share.share,
               default=max(found, key=lambda share: share.ceiling))


def _cells(share):
    told = f"{share.share:.2f}" if share.measured else f"not measured: ceiling below {LEAST_CEILING}"
    return [text.number(share.one_ms), f"{share.ratio:.2f}", f"{share.ceiling:.2f}", told]


def lines_of_shares(found):
    """A table of the rock piles, and one of Large Rock Pile, where the least of the combinations is shown."""
    times = ("one thread, ms", "ratio", "ceiling")
    piles = [[share.bodies, f"{share.cfm:g}", share.solver, *_cells(share)] for share in of_scene(found, "rock_pile")]
    large = [[step, least(of_step).combination, *_cells(least(of_step)),
              f"{sum(share.measured for share in of_step)} of {len(of_step)}"]
             for step, of_step in by_step(of_scene(found, "large_rock_pile")).items()]
    return "\n\n".join([text.table(("rocks", "cfm", "solver", *times, "share"), piles),
                        text.table(("Large Rock Pile, step", "combination", *times, "least share", "measured"), large)])


def by_load(rows):
    """{busy loops: t_s in ms}, fewest loops first"""
    return {int(loops): time for (loops,), time in sorted(_medians(rows, "busy_loops").items())}
