"""Signals that end trials wait while a process is made: Python drops what a handler raises in its hooks at a fork, and a child
that nobody has noted yet would be left running."""
import contextlib
import signal

ENDING = signal.SIGINT, signal.SIGTERM


@contextlib.contextmanager
def held():
    """They are heard at the end of the outermost. A child made meanwhile calls let_through()."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, ENDING)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def let_through():
    signal.pthread_sigmask(signal.SIG_UNBLOCK, ENDING)
