"""Files that may be damaged are opened in a process of their own: a library that crashes takes only that with it."""
import multiprocessing
import signal

from cleave_scripts.torture.signals import held, let_through

FORK = multiprocessing.get_context("fork")
SECONDS = 60


class Unreadable(Exception):
    """The text says why."""


def guarded(function, *arguments, seconds=SECONDS):
    """What the function returns; Unreadable where it raises, crashes or takes too long."""
    ours, theirs = FORK.Pipe(duplex=False)
    worker = FORK.Process(target=_answer, args=(theirs, function, arguments), daemon=True)
    try:
        with held():
            worker.start()
            theirs.close()
        if not ours.poll(seconds):
            raise Unreadable("takes too long to read")
        worked, value = ours.recv()
    except EOFError:
        raise Unreadable("crashes the reader") from None
    finally:
        if worker.pid:
            worker.kill()
            worker.join()
        ours.close()
    if not worked:
        raise Unreadable(value)
    return value


def _answer(pipe, function, arguments):
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # of a terminal, which sends it to all
    let_through()
    try:
        answer = True, function(*arguments)
    except Exception as error:  # whatever a library makes of a damaged file
        answer = False, f"{type(error).__name__}: {error}".splitlines()[0]
    pipe.send(answer)
