"""The kinds of trials: a file and a row here each. `trial` makes one, `missing` says why none can be made here."""
import dataclasses
import typing

from cleave_scripts.torture import (campaign_flips, campaign_kills, command_lines, edits, flips, full_disk, interrupts, kills,
                                    low_memory, problem_files, problem_flips, random_runs, streams, two_processes)


@dataclasses.dataclass(frozen=True)
class Kind:
    name: str
    about: str
    trial: typing.Callable
    share: int = 1  # of the time
    missing: typing.Callable = lambda: None


KINDS = (
    Kind("problem-files", "a problem file changed in structure or values, given to verify and replay", problem_files.trial,
         3),
    Kind("problem-flips", "bytes or bits flipped in a problem file, given to verify and replay", problem_flips.trial),
    Kind("flips", "a byte or bit flipped in any file of an output directory, which verify names", flips.trial),
    Kind("edits", "an edit of steps.csv, also with the checksums written again, which verify finds", edits.trial),
    Kind("kills", "SIGKILL at a random moment; what is left is whole, and the command completes", kills.trial, 2),
    Kind("interrupts", "SIGINT or SIGTERM at a random moment; the program ends by itself and says so", interrupts.trial),
    Kind("two-processes", "two commands that write one directory", two_processes.trial),
    Kind("full-disk", "an output directory on a small disk", full_disk.trial, 1, full_disk.missing),
    Kind("low-memory", "30 MB to 1 GB of address space", low_memory.trial),
    Kind("streams", "standard streams that are closed or full", streams.trial),
    Kind("command-lines", "words of a command line wrong, missing, doubled or moved", command_lines.trial),
    Kind("campaign-flips", "a byte or bit flipped in any file of a campaign, which verify names", campaign_flips.trial),
    Kind("campaign-kills", "SIGKILL of a campaign of 200 cells, ten times, on a small disk too; the command completes it",
         campaign_kills.trial, 1, full_disk.missing),
    Kind("random-runs", "random scenes, options and combinations, every row judged", random_runs.trial, 3),
)
