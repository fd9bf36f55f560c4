"""Programs under trial: niced children, each the head of a group of its own, under limits of time and memory."""
import dataclasses
import os
import resource
import signal
import subprocess
import time

from cleave_scripts.torture.signals import held, let_through

NICE = 5
MOST_KEPT = 1 << 20  # characters of what a child prints


@dataclasses.dataclass(frozen=True)
class Ending:
    """How a child ended: its exit code, or less the signal that ended it."""
    command: tuple
    code: int
    out: str
    err: str
    seconds: float
    hung: bool

    def lines(self):
        return self.err.splitlines()


def in_shell(command, memory_mb, streams):
    """The command with so much address space and such redirections, which hold for nobody but the program."""
    if not memory_mb and not streams:
        return command
    return ["/bin/sh", "-c", f'ulimit -v "$0" && exec "$@" {streams}', str(memory_mb * 1024 if memory_mb else "unlimited"),
            *command]


def start(command, directory, memory_mb=None, streams=""):
    """streams: redirections as the shell writes them, such as 2>&-"""
    with held():
        return subprocess.Popen(in_shell(list(map(str, command)), memory_mb, streams), cwd=directory, stdin=subprocess.DEVNULL,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, process_group=0, preexec_fn=_be_modest)


def _be_modest():
    let_through()
    os.setpriority(os.PRIO_PROCESS, 0, max(NICE, os.getpriority(os.PRIO_PROCESS, 0)))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def finish(child, seconds):
    """The Ending of a started child, which is killed with its group when it takes longer."""
    begin, hung = time.monotonic(), False
    try:
        out, err = child.communicate(timeout=seconds)
    except subprocess.TimeoutExpired:
        hung = True
        kill_group(child)
        out, err = child.communicate()
    finally:
        kill_group(child)
    return Ending(tuple(child.args), child.returncode, _text(out), _text(err), time.monotonic() - begin, hung)


def kill_group(child, number=signal.SIGKILL):
    """Also what the child has started; nothing where all of it has ended."""
    try:
        os.killpg(child.pid, number)
    except ProcessLookupError:
        pass


def _text(printed):
    return printed[:MOST_KEPT].decode("utf-8", "backslashreplace")
