"""Little memory: a row out_of_memory, or one line; never a crash, a hang or a row that is wrong."""
import shutil

from cleave_scripts.torture.commands import OUT, choose
from cleave_scripts.torture.directories import broken_files
from cleave_scripts.torture.endings import BAD_INPUT, DONE, ROWS_FAILED
from cleave_scripts.torture.rows import judge_rows, read_rows

LEAST_MB, MOST_MB = 30, 1024
EXPECTED = {"ok", "not_converged", "out_of_memory", "skipped"}
NOT_LOADED = 127  # of the dynamic loader, which says so in one line
DENSE = ("run", "--scene", "rock_pile", "--steps", "30", "--measure-every", "30", "--partitioner", "mix", "--refiner", "fm",
         "--solver", "dense,schur,monolithic,exact", "--repeats", "1")


def trial(trial):
    memory_mb = int(LEAST_MB * (MOST_MB / LEAST_MB)**trial.random.random())
    trial.random.choice([_list, _verify, _write, _write, _dense])(trial, memory_mb)


def _list(trial, memory_mb):
    _run(trial, ("list", ), memory_mb, (DONE, ))


def _verify(trial, memory_mb):
    undisturbed = trial.material.undisturbed[trial.random.choice(["record", "replay"])]
    shutil.copytree(undisturbed.directory, trial.directory / OUT)
    ending = _run(trial, ("verify", OUT), memory_mb, (DONE, ))
    if "damaged" in ending.err:
        trial.find("verify with little memory: calls a file damaged that is not", ending.err)


def _write(trial, memory_mb):
    name, words, _ = choose(trial)
    _write_words(trial, words, memory_mb)
    problems = {path.name: path for path in (trial.directory / "in").glob("*.h5")}
    if name == "replay" and (trial.directory / OUT / "steps.csv").is_file():
        judge_rows(trial, trial.directory / OUT, problems)


def _dense(trial, memory_mb):
    _write_words(trial, (*DENSE, "--bodies", trial.random.choice([30, 100, 200, 400])), memory_mb)


def _write_words(trial, words, memory_mb):
    ending = _run(trial, (*words, "--out", OUT), memory_mb, (DONE, ROWS_FAILED))
    directory = trial.directory / OUT
    for file, why in broken_files(directory):
        trial.find(f"{words[0]} with little memory: leaves a broken file", f"{file} {why}")
    if ending.code == ROWS_FAILED:
        others = {row["status"] for row in read_rows(trial, directory / "steps.csv")} - EXPECTED
        if others:
            trial.find(f"{words[0]} with little memory: rows that say {sorted(others)}")


def _run(trial, words, memory_mb, well):
    ending = trial.finish(trial.start(*words, memory_mb=memory_mb))
    if ending.code == NOT_LOADED and len(ending.lines()) == 1:
        trial.count("refused")
    elif trial.check(ending, f"{words[0]} with little memory", (*well, BAD_INPUT)):
        trial.count("refused" if ending.code == BAD_INPUT else "accepted")
    return ending
