"""SIGKILL of a whole campaign at random moments, one in five of them on a disk that is too small:
the same command completes it."""
import signal

from cleave_scripts.torture import child, full_disk
from cleave_scripts.torture.campaigns import check_complete, check_left, spec_of
from cleave_scripts.torture.endings import BAD_INPUT, DONE

KILLS = 10  # of a campaign
ON_SMALL_DISK = 5  # the first of so many campaigns
LONGEST_S = 1.5
LARGE_KB = 1 << 20


def trial(trial):
    spec, undisturbed = spec_of(trial), trial.material.campaign
    if trial.number % ON_SMALL_DISK != 0:
        _kill_often(trial, spec, trial.directory / "out")
        _complete(trial, spec, trial.directory / "out", undisturbed)
        return
    with full_disk.small_disk(trial, full_disk.random_size_kb(trial, _size_kb(undisturbed))) as disk:
        _kill_often(trial, spec, disk / "out")
        _fill(trial, spec, disk / "out")
        full_disk.enlarge(trial, disk, LARGE_KB)
        _complete(trial, spec, disk / "out", undisturbed)


def _size_kb(directory):
    """On a disk of whole pages."""
    return sum(full_disk.PAGE_KB * (1 + path.stat().st_size // 1024 // full_disk.PAGE_KB) for path in directory.rglob("*"))


def _kill_often(trial, spec, out):
    for _ in range(KILLS):
        jobs = trial.random.choice([(), ("--jobs", "3")])
        started = trial.start("sweep", spec, "--out", out, *jobs)
        trial.wait(trial.random.uniform(0, LONGEST_S))
        child.kill_group(started)
        if trial.finish(started).code == -signal.SIGKILL:
            trial.count("kills")
    check_left(trial, out)


def _fill(trial, spec, out):
    ending = trial.finish(trial.start("sweep", spec, "--out", out, "--quiet"))
    if not trial.check(ending, "sweep on a small disk", (DONE, BAD_INPUT)) or ending.code == DONE:
        return
    trial.count("refused")
    if full_disk.CAUSE not in ending.err:
        trial.find("sweep on a small disk: does not name the cause", ending.err)
    check_left(trial, out)


def _complete(trial, spec, out, undisturbed):
    if trial.check(trial.finish(trial.start("sweep", spec, "--out", out)), "sweep again", (DONE, )):
        trial.count("restarts")
        check_complete(trial, out, undisturbed)
