"""Commands that write a directory, on inputs that lie in the directory of the trial."""
import shutil

from cleave_scripts.torture.directories import broken_files, experiment_rows, final_files, state
from cleave_scripts.torture.endings import BAD_INPUT, CHECK_FAILED, DONE, ROWS_FAILED

OUT = "out"


def choose(trial):
    """(name of a command, its words without --out, what it leaves undisturbed)"""
    name = trial.random.choice(sorted(trial.material.undisturbed))
    undisturbed = trial.material.undisturbed[name]
    return name, [_brought(trial, word) for word in undisturbed.words], undisturbed


def _brought(trial, word):
    """A problem file of the material becomes a copy beside the output; one copy, as another command may be reading it."""
    if not str(word).endswith(".h5"):
        return word
    target = trial.directory / "in" / word.name
    target.parent.mkdir(exist_ok=True)
    if not target.exists():
        shutil.copyfile(word, target)
    return f"in/{word.name}"


def moment(trial, undisturbed):
    """Seconds after the start; many of them among the first, when files are made, and past what it took undisturbed."""
    share = trial.random.choice([trial.random.uniform(0, 0.3), trial.random.uniform(0, 1.1), trial.random.uniform(0, 2)])
    return share * undisturbed.seconds


def check_left(trial, name, directory):
    """What a disturbed command has left: whole files, and `verify` does not take it for a finished run."""
    for file, why in broken_files(directory):
        trial.find(f"{name}: leaves {_kind_of(file)} that is broken", f"{file} {why}")
    if not final_files(directory):
        return
    told = state(directory)
    allowed = {"complete": (DONE, CHECK_FAILED), None: (BAD_INPUT, CHECK_FAILED)}.get(told, (CHECK_FAILED, ))
    ending = trial.finish(trial.start("verify", directory.name))
    if ending.code == DONE and DONE not in allowed:
        trial.find(f"verify: believes what a disturbed {name} left", f"state {told}")
    else:
        trial.check(ending, f"verify of a disturbed {name}", allowed)


def check_completes(trial, name, words, undisturbed):
    """The same command with --force makes what it makes undisturbed, and nothing else is left."""
    directory = trial.directory / OUT
    ending = trial.finish(trial.start(*words, "--out", OUT, "--force"))
    if not trial.check(ending, f"{name} again", (DONE, ROWS_FAILED)):
        return
    trial.count("restarts")
    trial.run("verify", OUT, allowed=(DONE, ))
    names = [{path.name for path in place.iterdir()} for place in (directory, undisturbed.directory)]
    if names[0] != names[1]:
        trial.find(f"{name} again: leaves other files", str(sorted(names[0] ^ names[1])))
    try:
        same = experiment_rows(directory) == experiment_rows(undisturbed.directory)
    except (OSError, ValueError, KeyError, TypeError) as error:
        trial.find(f"{name} again: cannot be read", str(error))
    else:
        if not same:
            trial.find(f"{name} again: has other rows")


def _kind_of(file):
    return file if not file.endswith(".h5") or file == "motion.h5" else "a problem file"
