"""Campaigns of `cleave sweep` as material, and what has to hold of one that was disturbed and completed."""
import csv

from cleave_scripts.results.errors import ResultError, last_line
from cleave_scripts.torture import child
from cleave_scripts.torture.directories import LOCK, broken_files, experiment_rows, final_files
from cleave_scripts.torture.endings import CHECK_FAILED, DONE, ROWS_FAILED

LONGEST_S = 600
CELLS = 200
SMALL = """scene = "rock_pile"
bodies = 3
steps = 4
measure-every = 2
repeats = 1
partitioner = "mindp"
refiner = "none"
solver = "exact"
"""
SPEC = SMALL + f"seed = {{ from = 1, to = {CELLS}, step = 1 }}\n"
# Three cells, of which one is ended for the time it takes.
MIXED = SMALL + """seed = [1, 2]

[[include]]
scene = "rock_pile"
steps = 100000000
measure-every = 100000000
"""


def spec_of(trial):
    """The path of the spec of many cells in the directory of a trial."""
    (trial.directory / "spec.toml").write_text(SPEC)
    return "spec.toml"


def make(program, directory):
    """The campaign of SPEC, undisturbed, in a folder of the directory of the material."""
    out = _begin(directory, "campaign", SPEC)
    _run(program, directory, "sweep", "campaign/spec.toml", "--out", out)
    return directory / out


def make_mixed(program, directory):
    """That of MIXED in two shares, one index of both, and the table of its rows: all kinds of files that a campaign has."""
    out = _begin(directory, "mixed_campaign", MIXED)
    for more in (("--shard", "1/2", "--cell-seconds", "1"), ("--shard", "2/2", "--cell-seconds", "1"), ("--merge", )):
        _run(program, directory, "sweep", "mixed_campaign/spec.toml", "--out", out, *more, allowed=(DONE, ROWS_FAILED))
    _run(program, directory, "collect", out, "--out", f"{out}/results.csv")
    return directory / out


def _begin(directory, name, spec):
    (directory / name).mkdir(parents=True)
    (directory / name / "spec.toml").write_text(spec)
    return f"{name}/out"


def _run(program, directory, *words, allowed=(DONE, )):
    ending = child.finish(child.start([program, *words], directory), LONGEST_S)
    if ending.code not in allowed:
        raise ResultError(f"nothing to try: {words[0]} stopped with exit code {ending.code}: {last_line(ending.err)}")


def check_left(trial, out):
    """What a disturbed campaign has left: whole files, and nothing that is taken for a finished one."""
    for file, why in broken_files(out):
        trial.find(f"sweep: leaves {file} that is broken", why)
    if (out / "index.csv").exists():
        trial.check(trial.finish(trial.start("verify", out)), "verify of a disturbed campaign", (DONE, CHECK_FAILED))


def check_complete(trial, out, undisturbed):
    """Every cell is there once and ok, with the rows and files of the undisturbed campaign, and verify finds nothing."""
    trial.run("verify", out, allowed=(DONE, ))
    with open(out / "index.csv", newline="", encoding="utf-8") as file:
        cells = [(row["cell"], row["status"]) for row in csv.DictReader(file)]
    names = {path.name for path in (undisturbed / "cells").iterdir()}
    if len(cells) != len(names) or set(cells) != {(name, "ok") for name in names}:
        trial.find("sweep again: not every cell is there once and ok", str(cells))
    lists = [sorted(str(path.relative_to(root)) for path in final_files(root)) for root in (out, undisturbed)]
    if lists[0] != lists[1] or list(out.rglob(LOCK)):
        trial.find("sweep again: leaves other files", str(sorted(set(lists[0]) ^ set(lists[1]))))
    different = [name for name in sorted(names) if _rows(out / "cells" / name) != experiment_rows(undisturbed / "cells" / name)]
    if different:
        trial.find("sweep again: has other rows", " ".join(different))


def _rows(cell):
    try:
        return experiment_rows(cell)
    except (OSError, ValueError, KeyError, TypeError) as error:
        return str(error)
