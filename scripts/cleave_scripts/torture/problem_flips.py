"""A byte or bit changed in a problem file on its own: found, or the file says what it said before."""
import shutil

from cleave_scripts.torture.endings import BAD_INPUT, CHECK_FAILED, DONE, ROWS_FAILED
from cleave_scripts.torture.flips import flip
from cleave_scripts.torture.guarded import Unreadable, guarded
from cleave_scripts.torture.meaning import meaning
from cleave_scripts.torture.rows import judge_rows

MOST_FLIPS = 3
COMBINATION = ("--partitioner", "mix", "--refiner", "fm", "--solver", "schur", "--repeats", "1")


def trial(trial):
    source = trial.random.choice([*trial.material.problems, *trial.material.solved])
    path = trial.directory / "problem.h5"
    shutil.copyfile(source, path)
    trial.note(f"problem.h5: {source.name} of {source.parent.name}")
    for _ in range(trial.random.choice([1, 1, 1, MOST_FLIPS])):
        flip(trial, path)
    verified = trial.run("verify", "problem.h5", allowed=(DONE, BAD_INPUT, CHECK_FAILED))
    replayed = trial.run("replay", "problem.h5", *COMBINATION, "--write-solutions", "--out", "out",
                         allowed=(DONE, BAD_INPUT, ROWS_FAILED))
    changed = _is_changed(source, path)
    if verified.code in (BAD_INPUT, CHECK_FAILED):
        trial.count("noticed")
    elif changed and verified.code == DONE:
        trial.find(f"verify: believes a problem file {changed}")
    elif not changed:
        trial.count("harmless")
    if replayed.code in (DONE, ROWS_FAILED):
        judge_rows(trial, trial.directory / "out", {"problem.h5": path})
        if changed and _is_changed(source, path, ("solution", "partition")):  # which replay writes anew
            trial.find(f"replay: believes a problem file {changed}")


def _is_changed(source, path, but=()):
    """In words; None where it says what it said, but for what stands in some groups."""
    def told(file):
        return {name: value for name, value in guarded(meaning, file).items() if not name.startswith(but)}

    try:
        return None if told(path) == told(source) else "that is changed"
    except Unreadable:
        return "that h5py cannot read"
