"""Two processes on one --out: one is told who holds the directory, and what the other makes is clean."""
from cleave_scripts.torture.commands import OUT, choose
from cleave_scripts.torture.directories import broken_files, final_files
from cleave_scripts.torture.endings import BAD_INPUT, DONE, ROWS_FAILED

FULL = "already holds"
ENDED_WELL = (DONE, ROWS_FAILED)


def trial(trial):
    started = []
    for _ in range(2):
        name, words, undisturbed = choose(trial)
        force = ["--force"] if trial.random.random() < 0.5 else []
        started.append((name, trial.start(*words, "--out", OUT, *force), force))
        if len(started) == 1:
            trial.wait(trial.random.choice([0, trial.random.uniform(0, 0.03), trial.random.uniform(0, undisturbed.seconds)]))
            first_had_ended = started[0][1].poll() is not None
    endings = [trial.finish(process) for _, process, _ in started]
    for (name, _, _), ending in zip(started, endings):
        trial.check(ending, f"{name}, one of two", (*ENDED_WELL, BAD_INPUT))
    check_refusal(trial, started, endings, first_had_ended)
    _check_directory(trial, endings)


def check_refusal(trial, started, endings, first_had_ended):
    refused = [number for number, ending in enumerate(endings) if ending.code == BAD_INPUT]
    second_had_force = bool(started[1][2])
    if not refused:
        # With --force one may begin when the other has ended, and who was started first need not be first.
        if not any(force for _, _, force in started):
            trial.find("two processes write one directory")
    elif len(refused) == 2:
        trial.find("two processes refuse each other", "".join(ending.err for ending in endings))
    elif not first_had_ended and second_had_force:
        other = started[1 - refused[0]][1]
        # Overtaken before it looked, the first finds what the other has made and left.
        overtaken = refused[0] == 0 and not started[0][2] and FULL in endings[0].err
        if not overtaken and str(other.pid) not in endings[refused[0]].err:
            trial.find("the refused process is not told who holds the directory", endings[refused[0]].err)


def _check_directory(trial, endings):
    directory = trial.directory / OUT
    for file, why in broken_files(directory):
        trial.find("two processes leave a broken file", f"{file} {why}")
    if any(ending.code in ENDED_WELL for ending in endings) and final_files(directory):
        trial.run("verify", OUT, allowed=(DONE, ))
