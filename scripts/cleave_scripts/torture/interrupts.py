"""SIGINT or SIGTERM at a random moment: the program ends by itself and says that it was interrupted."""
import signal

from cleave_scripts.torture.commands import OUT, check_completes, check_left, choose, moment
from cleave_scripts.torture.directories import final_files, state
from cleave_scripts.torture.endings import DONE, INTERRUPTED, ROWS_FAILED

SIGNALS = (signal.SIGINT, signal.SIGTERM)
LONG = ("run", "--scene", "large_rock_pile", "--bodies", "300", "--steps", "400", "--repeats", "3", "--partitioner", "all",
        "--refiner", "all", "--solver", "schur,monolithic,exact")
LONG_SHARE = 0.05
SETTLED_S = (2.0, 8.0)


def trial(trial):
    name, words, undisturbed = choose(trial)
    is_long = trial.random.random() < LONG_SHARE
    if is_long:
        name, words = "a long run", LONG
    number = trial.random.choice(SIGNALS)
    started = trial.start(*words, "--out", OUT)
    trial.wait(trial.random.uniform(*SETTLED_S) if is_long else moment(trial, undisturbed))
    trial.note(f"  {number.name}")
    started.send_signal(number)
    ending = trial.finish(started)
    directory = trial.directory / OUT
    # Before the program listens, the signal ends it, as it ends any; then it has made nothing yet.
    if ending.code == -number and not final_files(directory):
        return
    if trial.check(ending, f"{name} after {number.name}", (INTERRUPTED, DONE, ROWS_FAILED)) and ending.code == INTERRUPTED:
        trial.count("kills")
        if final_files(directory) and state(directory) != "interrupted":
            trial.find(f"{name} after {number.name}: the manifest does not say interrupted", str(state(directory)))
    check_left(trial, name, directory)
    if not is_long:
        check_completes(trial, name, words, undisturbed)
