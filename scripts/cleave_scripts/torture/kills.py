"""SIGKILL at a random moment: what stands under a final name is whole, and the same command completes."""
import signal

from cleave_scripts.torture import child
from cleave_scripts.torture.commands import OUT, check_completes, check_left, choose, moment


def trial(trial):
    name, words, undisturbed = choose(trial)
    for number in range(trial.random.choice([1, 1, 2])):
        started = trial.start(*words, "--out", OUT, *(["--force"] if number else []))
        trial.wait(moment(trial, undisturbed))
        child.kill_group(started)
        ending = trial.finish(started)
        if ending.code == -signal.SIGKILL:
            trial.count("kills")
        check_left(trial, name, trial.directory / OUT)
    check_completes(trial, name, words, undisturbed)
