"""What scripts/compare_builds measured: the same recorded steps, solved from zero impulses by an earlier build and by this one.

The time of a step is the shortest t_s_ms of its rounds; a figure of a problem and solver is the mean over its steps, of
which both builds solved each.
"""
import dataclasses
import math
import statistics

from cleave_scripts.results.rows import group
from cleave_scripts.table import text

BUILDS = ("earlier", "this")
# The last commit whose solver was serial but for the factorisation of parts.
SERIAL = "d45a41a49276db2267dc409d03556f1340693042"
SOLVERS = ("exact", "schur", "pivot:schur-bodies")
# (scene, options of `cleave record`, steps)
PROBLEMS = tuple(("rock_pile", ("--bodies", bodies, "--cfm", cfm), (200, 300, 400))
                 for bodies in (200, 600) for cfm in ("1e-5", "1e-10"))
PROBLEMS += (("chain_drop", (), (100, 300)), ("log_tower", (), (100, 300)), ("large_rock_pile", (), (200,)))
COLUMNS = ("build", "git_hash", "scene", "bodies", "cfm", "step", "rows", "solver", "threads", "round", "status",
           "factorizations", "t_s_ms")


@dataclasses.dataclass(frozen=True)
class Change:
    """Of a problem and solver."""
    key: tuple  # scene, bodies, cfm, solver
    steps: int
    earlier_ms: float
    this_ms: float
    failed: tuple  # steps that each build did not solve

    @property
    def ratio(self):
        return self.this_ms / self.earlier_ms


def _shortest_ms(rows):
    """Of the rounds of one step by one build; nan where it was not solved."""
    return min(float(row["t_s_ms"]) for row in rows) if all(row["status"] == "ok" for row in rows) else math.nan


def _times_ms(of_step):
    """One step by each of BUILDS."""
    by_build = group(of_step, "build")
    return [_shortest_ms(by_build[build,]) for build in BUILDS]


def _change(key, rows):
    times = [_times_ms(of_step) for of_step in group(rows, "step").values()]
    solved = [pair for pair in times if not any(map(math.isnan, pair))]
    means = map(statistics.fmean, zip(*solved)) if solved else (math.nan, math.nan)
    return Change(key, len(times), *means, tuple(sum(map(math.isnan, of_build)) for of_build in zip(*times)))


def changes(rows):
    return [_change(key, of_key) for key, of_key in group(rows, "scene", "bodies", "cfm", "solver").items()]


def summary(found):
    ratios = [change.ratio for change in found if not math.isnan(change.ratio)]
    if not ratios:
        return f"0 figures of {len(found)}"
    return (f"{len(ratios)} figures of {len(found)}, {statistics.geometric_mean(ratios):.2f} of the earlier time on the "
            f"geometric mean, at most {max(ratios):.2f}")


def commits(rows):
    """(earlier, this), ten digits of each."""
    hashes = {row["build"]: row["git_hash"][:10] for row in rows}
    return tuple(hashes[build] for build in BUILDS)


def markdown(rows):
    earlier, this = commits(rows)
    shown = []
    for change in changes(rows):
        scene, bodies, cfm, solver = change.key
        shown.append([scene, bodies, f"{float(cfm):g}", f"`{solver}`", change.steps, text.number(change.earlier_ms),
                      text.number(change.this_ms), text.number(change.ratio), _not_solved(change)])
    return text.table(["scene", "bodies", "cfm", "solver", "steps", f"ms, {earlier}", f"ms, {this}", "ratio", "not solved"],
                      shown)


def _not_solved(change):
    return ", ".join(f"{count} by {build} build" for count, build in zip(change.failed, ("the earlier", "this"))
                     if count) or "-"
