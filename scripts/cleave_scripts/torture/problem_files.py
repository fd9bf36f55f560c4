"""Variants of problem files, each given to `verify` and to `replay`: refused in one line, or accepted and judged."""
import dataclasses
import shutil

import h5py

from cleave_scripts.torture import changes_of_layout, changes_of_solutions, changes_of_values
from cleave_scripts.torture.changes_of_solutions import UNTRUE
from cleave_scripts.torture.changes_of_values import ANY, REFUSED
from cleave_scripts.torture.endings import BAD_INPUT, CHECK_FAILED, DONE, ROWS_FAILED
from cleave_scripts.torture.foreign_file import write_foreign
from cleave_scripts.torture.rows import judge_rows

ARRAY_CHANGES = (*changes_of_values.CHANGES, *changes_of_layout.CHANGES, *changes_of_solutions.CHANGES)
FILE_CHANGES = changes_of_solutions.FILE_CHANGES
OURS = 0.2  # share of variants that keep what the program itself has put into the file
TWICE = 0.25  # share of those that may be accepted which are changed once more
COMBINATIONS = ("--partitioner", "mindp,mix", "--refiner", "none,fm", "--max-bodies", "3", "--solver",
                "schur,pgs,interior-point:monolithic", "--repeats", "1")
MEMORY_MB = 2048  # enough for any file here: who asks for more has believed a size
VERIFY = {REFUSED: (BAD_INPUT, CHECK_FAILED), UNTRUE: (BAD_INPUT, CHECK_FAILED), ANY: (DONE, BAD_INPUT, CHECK_FAILED)}
REPLAY = {REFUSED: (BAD_INPUT, ), UNTRUE: (DONE, BAD_INPUT, ROWS_FAILED), ANY: (DONE, BAD_INPUT, ROWS_FAILED)}


def trial(trial):
    path = trial.directory / "problem.h5"
    expected, name = make_variant(trial, path)
    verified = _run(trial, "verify", VERIFY[expected], name, "problem.h5")
    replayed = _run(trial, "replay", REPLAY[expected], name, "problem.h5", *COMBINATIONS, "--write-solutions", "--out",
                    "out")
    trial.count("refused" if BAD_INPUT in (verified.code, replayed.code) else "accepted")
    out = trial.directory / "out"
    if replayed.code in (DONE, ROWS_FAILED):
        judge_rows(trial, out, {"problem.h5": path})
    elif replayed.code == BAD_INPUT and out.is_dir() and any(out.iterdir()):
        trial.find("replay: refuses and writes", str(sorted(out.iterdir())))


def make_variant(trial, path):
    """(what has to come of it, the change in words)"""
    dice = trial.random
    source = dice.choice([*trial.material.problems, *trial.material.solved])
    name, expected, change = dice.choice([*ARRAY_CHANGES, *FILE_CHANGES])
    ours = dice.random() < OURS
    trial.note(f"problem.h5: {source.name}{'' if ours else ' as others write it'}; {name}")
    (shutil.copyfile if ours else write_foreign)(source, path)
    if (name, expected, change) in FILE_CHANGES:
        change(path, dice)
    else:
        with h5py.File(path, "r+") as file:
            change(file, dice)
            if expected == ANY and dice.random() < TWICE:
                _change_again(trial, file)
    return expected, name


def _change_again(trial, file):
    """The second change may not find what the first has removed."""
    name, expected, change = trial.random.choice(changes_of_values.CHANGES)
    if expected == ANY:
        try:
            change(file, trial.random)
            trial.note(f"problem.h5: {name}")
        except (KeyError, ValueError, TypeError, IndexError, OSError) as error:
            trial.note(f"problem.h5: not {name}: {error}")


def _run(trial, command, allowed, change, *words):
    """A finding names the change."""
    before = len(trial.findings)
    ending = trial.run(command, *words, allowed=allowed, memory_mb=MEMORY_MB)
    if ending.code == BAD_INPUT and "memory" in ending.err:
        trial.find(f"{command}: believes a size")
    trial.findings[before:] = [dataclasses.replace(found, what=f"{found.what}: {change}")
                               for found in trial.findings[before:]]
    return ending
