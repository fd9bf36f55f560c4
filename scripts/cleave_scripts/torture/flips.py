"""A byte or bit changed in any file of an output directory: `verify` has to find it and to name the file."""
import shutil

from cleave_scripts.torture.directories import final_files
from cleave_scripts.torture.endings import BAD_INPUT, CHECK_FAILED


def trial(trial):
    command = trial.random.choice(sorted(trial.material.undisturbed))
    directory = trial.directory / "out"
    shutil.copytree(trial.material.undisturbed[command].directory, directory)
    path = trial.random.choice(final_files(directory))
    flip(trial, path)
    ending = trial.finish(trial.start("verify", "out"))
    name = path.name if path.suffix != ".h5" or path.name == "motion.h5" else "a problem file"
    if ending.code == 0:
        trial.find(f"verify: believes a flip in {name} of {command}")
    elif trial.check(ending, "verify", (BAD_INPUT, CHECK_FAILED)):
        if path.name in ending.out + ending.err:
            trial.count("noticed")
        else:
            trial.find(f"verify: does not name {name} of {command}", ending.err or ending.out)


def flip(trial, path):
    """Another byte, or another bit of one."""
    content, dice = bytearray(path.read_bytes()), trial.random
    place, mask = dice.randrange(len(content)), dice.choice([1 << dice.randrange(8), dice.randrange(1, 256)])
    content[place] ^= mask
    path.write_bytes(content)
    trial.note(f"{path.name}: byte {place} ^ {mask:#04x}")
