"""A byte or bit changed in any file of a campaign, its index and merged tables among them:
`verify` has to find it and to name the file."""
import shutil

from cleave_scripts.torture.directories import final_files
from cleave_scripts.torture.endings import BAD_INPUT, CHECK_FAILED
from cleave_scripts.torture.flips import flip


def trial(trial):
    directory = trial.directory / "out"
    shutil.copytree(trial.material.mixed_campaign, directory)
    kinds = {}
    for path in final_files(directory):
        kinds.setdefault((path.name if path.parent.name != "failed" else "log", path.relative_to(directory).parts[0]),
                         []).append(path)
    path = trial.random.choice(kinds[trial.random.choice(sorted(kinds))])
    flip(trial, path)
    ending = trial.finish(trial.start("verify", "out"))
    if ending.code == 0:
        trial.find(f"verify: believes a flip in {path.name} of a campaign")
    elif trial.check(ending, "verify of a campaign", (BAD_INPUT, CHECK_FAILED)):
        if path.name in ending.out + ending.err:
            trial.count("noticed")
        else:
            trial.find(f"verify: does not name {path.name} of a campaign", ending.err or ending.out)
