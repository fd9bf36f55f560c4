"""An output directory on a disk of random small size: one error line that names file and cause, and no half files."""
import contextlib
import shutil
import subprocess
import tempfile

from cleave_scripts.torture.commands import choose
from cleave_scripts.torture.directories import broken_files
from cleave_scripts.torture.endings import BAD_INPUT, DONE, ROWS_FAILED

PAGE_KB = 4
CAUSE = "No space left on device"


def missing():
    """Why no small disk can be had, or None."""
    with tempfile.TemporaryDirectory() as place:
        try:
            _mount(place, PAGE_KB)
        except (OSError, subprocess.CalledProcessError) as error:
            return f"no disk of a small size can be mounted: {getattr(error, 'stderr', None) or error}".strip()
        _unmount(place)
    return None


def _mount(place, size_kb):
    subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size_kb}k", "tmpfs", str(place)], check=True, capture_output=True,
                   text=True)


def _unmount(place):
    if subprocess.run(["umount", str(place)], check=False, capture_output=True).returncode != 0:
        subprocess.run(["umount", "--lazy", str(place)], check=True, capture_output=True)


@contextlib.contextmanager
def small_disk(trial, size_kb):
    """The directory of a disk of this size; what lies on it is kept where the trial has found something."""
    disk = trial.directory / "disk"
    disk.mkdir()
    trial.note(f"$ mount -t tmpfs -o size={size_kb}k tmpfs disk")
    _mount(disk, size_kb)
    try:
        yield disk
    finally:
        if trial.findings:
            shutil.copytree(disk, trial.directory / "left")
        _unmount(disk)


def enlarge(trial, disk, size_kb):
    trial.note(f"$ mount -o remount,size={size_kb}k disk")
    subprocess.run(["mount", "-o", f"remount,size={size_kb}k", str(disk)], check=True, capture_output=True)


def random_size_kb(trial, whole_kb):
    """Of a disk on which so many kB do not always fit."""
    return PAGE_KB * trial.random.randrange(1, max(2, int(1.5 * whole_kb) // PAGE_KB))


def trial(trial):
    name, words, undisturbed = choose(trial)
    whole_kb = sum(path.stat().st_size for path in undisturbed.directory.iterdir()) // 1024
    with small_disk(trial, random_size_kb(trial, whole_kb)):
        _fill(trial, name, words)


def _fill(trial, name, words):
    ending = trial.finish(trial.start(*words, "--out", "disk/out"))
    well = trial.check(ending, f"{name} on a small disk", (DONE, ROWS_FAILED, BAD_INPUT))
    for file, why in broken_files(trial.directory / "disk" / "out"):
        trial.find(f"{name} on a small disk: leaves a broken file", f"{file} {why}")
    if not well:
        return
    if ending.code != BAD_INPUT:
        trial.count("accepted")
        trial.run("verify", "disk/out", allowed=(DONE, ))
    elif CAUSE not in ending.err or "disk/out" not in ending.err:
        trial.find(f"{name} on a small disk: does not name file and cause", ending.err)
    else:
        trial.count("refused")
