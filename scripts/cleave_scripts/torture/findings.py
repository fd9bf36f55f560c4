"""Findings on the disk: the directory of the trial as it was left, with what repeats it, and a line for each."""
import dataclasses
import json
import os
import shlex
import shutil
import stat

MOST_KEPT = 3  # directories of equal findings; the others are counted, and their numbers repeat them
MOST_BYTES = 20 << 20


AGAIN = "again"  # where a finding is repeated: a run leaves nothing of what an earlier one has found in its directory


class Keeper:

    def __init__(self, out):
        self.out, self.lines, self.directory = out, out / "findings.jsonl", out / "findings"
        self.lines.unlink(missing_ok=True)
        shutil.rmtree(self.directory, ignore_errors=True)
        self.known = {}

    def keep(self, trial, say):
        """One line a finding. Whatever is new has a directory with its input and output."""
        name = f"{trial.kind}-{trial.number}"
        rare = any(self._is_rare(trial.kind, finding.what) for finding in trial.findings)
        if rare:
            _copy(trial.directory, self.directory / name)
        with open(self.lines, "a", encoding="utf-8") as file:
            for finding in trial.findings:
                told = {"kind": trial.kind, "seed": trial.seed, "trial": trial.number, **dataclasses.asdict(finding),
                        "log": trial.log, "kept": name if rare else None}
                file.write(json.dumps(told) + "\n")
                if rare:
                    say(f"finding: {trial.kind} {trial.number}: {finding.what} ({self.directory / name})")
        if rare:
            (self.directory / name / "how.txt").write_text("\n".join([
                f"scripts/torture --minutes 10 --trials {trial.kind} --seed {trial.seed} --only {trial.number} "
                f"--out {shlex.quote(str(self.out.absolute() / AGAIN))}", *trial.log,
                *(f"finding: {finding.what}\n{finding.detail}" for finding in trial.findings)]) + "\n", encoding="utf-8")

    def _is_rare(self, kind, what):
        count = self.known[kind, what] = self.known.get((kind, what), 0) + 1
        return count <= MOST_KEPT


def _copy(source, target):
    """Plain files up to a size and links as links; what would block or has no end is left out."""
    shutil.copytree(source, target, symlinks=True, ignore=_left_out, dirs_exist_ok=True)


def _left_out(directory, names):
    def is_odd(path):
        mode = os.lstat(path)
        return not (stat.S_ISREG(mode.st_mode) and mode.st_size <= MOST_BYTES or stat.S_ISDIR(mode.st_mode) or
                    stat.S_ISLNK(mode.st_mode))

    return [name for name in names if is_odd(os.path.join(directory, name))]
