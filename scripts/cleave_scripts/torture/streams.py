"""Standard streams that are closed or full: nothing of them lands in a file, and lost results are no success."""
import shutil
import signal

from cleave_scripts.torture.commands import OUT, choose
from cleave_scripts.torture.directories import broken_files
from cleave_scripts.torture.endings import BAD_INPUT, CHECK_FAILED, DONE, ROWS_FAILED, fault

LOSING = ">/dev/full"  # who closes a stream does not ask for what is printed there
ODD = (("", "<&-", "</dev/zero"), ("", ">&-", LOSING), ("", "2>&-", "2>/dev/full"))  # of each stream
ENDINGS = (DONE, BAD_INPUT, ROWS_FAILED, CHECK_FAILED)


def trial(trial):
    chosen = [stream for choices in ODD if (stream := trial.random.choice(choices))] or ["2>&-"]
    trial.random.choice([_print, _write])(trial, chosen)


def _print(trial, chosen):
    """Commands whose result is what they print."""
    recorded = trial.material.undisturbed["record"].directory
    shutil.copytree(recorded, trial.directory / OUT)
    words = trial.random.choice([("list", ), ("list", "solvers", "--names"), ("verify", OUT), ("--version", ), ("--help", )])
    ending = _run(trial, words, chosen)
    if ending.code == DONE and LOSING in chosen:
        trial.find(f"{words[0]} {LOSING}: loses what it prints, exit code 0")


def _write(trial, chosen):
    """Commands whose result is a directory."""
    name, words, _ = choose(trial)
    ending = _run(trial, (*words, "--out", OUT), chosen)
    for file, why in broken_files(trial.directory / OUT):
        trial.find(f"{name} {' '.join(chosen)}: leaves a broken file", f"{file} {why}")
    if ending.code in (DONE, ROWS_FAILED):
        trial.run("verify", OUT, allowed=(DONE, ))


def _run(trial, words, chosen):
    """The error line may be lost with its stream."""
    ending = trial.finish(trial.start(*words, streams=" ".join(chosen)))
    wrong = fault(ending, ENDINGS)
    own = [line for line in ending.err.splitlines() if line.startswith("cleave ")]
    if words[0] == "verify" and len(own) == 1:  # what it notes of each file comes before its error
        wrong = None
    if wrong and wrong != "no error line" and ending.code != -signal.SIGPIPE:
        trial.find(f"{words[0]} {' '.join(chosen)}: {wrong}", ending.err or ending.out)
    return ending
