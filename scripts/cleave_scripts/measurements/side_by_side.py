"""Replays on one thread, on two, and two on one thread each at the same time."""
import dataclasses
import statistics

from cleave_scripts.results.command import say
from cleave_scripts.results.errors import ResultError
from cleave_scripts.results.programs import replay_side_by_side


@dataclasses.dataclass(frozen=True)
class Way:
    name: str
    threads: int
    processes: int


WAYS = (Way("one thread", 1, 1), Way("two threads", 2, 1), Way("side by side", 1, 2))
TAILS = (1, 4, 16)  # replays of the first file at the end of an attempt: more where one core was slower than the other
MEDIANS = ("t_s_ms", "t_s_waiting_ms", "core_round_trip_ns")  # over the processes


def solve(program, scratch, files, repeats, way, *options, all_ok=True):
    """A row a counted cell, of cells that failed too unless all have to be ok. The first of the files is replayed once more
    before all of them, and again after them, which is not counted: so every process is solving for as long as another is at
    cells that count. Where that did not hold, all is solved again, with more to do at the end."""
    directories = [scratch / f"replay{number}" for number in range(way.processes)]
    before = _in_another_folder(files[0], scratch / "before")
    for tail in TAILS:
        after = [_in_another_folder(files[0], scratch / f"after{number}") for number in range(tail)]
        solved = replay_side_by_side(program, directories, [before, *files, *after], *options, "--repeats", repeats,
                                     "--threads", way.threads, all_ok=all_ok)
        cells = len(solved[0]) // (1 + len(files) + tail)  # of a file
        ends_s = [(directory / "steps.csv").stat().st_mtime for directory in directories]
        if _together(ends_s, [repeats * sum(row.number("t_s_ms") for row in rows[-tail * cells:]) / 1000 for rows in solved]):
            return [_merged(rows, way) for rows in zip(*(rows[cells:-tail * cells] for rows in solved), strict=True)]
        say(f"solves side by side ended {max(ends_s) - min(ends_s):.2g} s apart, so the last that count were alone")
    raise ResultError(f"solves side by side were not at the same time, {len(TAILS)} times; the machine has other work")


def _in_another_folder(file, folder):
    """A replay takes no file twice."""
    folder.mkdir(exist_ok=True)
    again = folder / file.name
    again.unlink(missing_ok=True)
    again.hardlink_to(file)
    return again


def _together(ends_s, tails_s):
    """tails_s: how long each process was at its last solves, which do not count."""
    return all(end_s - min(ends_s) <= tail_s for end_s, tail_s in zip(ends_s, tails_s, strict=True))


def _merged(rows, way):
    medians = {column: statistics.median(row.number(column) for row in rows) for column in MEDIANS}
    return {**rows[0], **medians, "threads": way.threads, "processes": way.processes}
