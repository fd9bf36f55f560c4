"""How every command of scripts/ ends: what it could not do is one line, and the exit code says the rest."""
import os
import signal
import sys

from cleave_scripts.results.command_line import one_line
from cleave_scripts.results.errors import AlreadyTold, Interrupted, ResultError

OK, BAD, INTERRUPTED, NO_READER = 0, 1, 130, 128 + signal.SIGPIPE


def command_name():
    return os.path.basename(sys.argv[0])


def say(text):
    """A line about the work, beside its results."""
    print(f"{command_name()}: {text}", file=sys.stderr, flush=True)


def run_command(main):
    """Ends the process as main() says: with the exit code that it returns, or 0."""
    _open_standard_streams()
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # so that programs are stopped and scratch is removed
    sys.exit(_guarded(main))


def _open_standard_streams():
    """A closed one must not become the number of a file that is written later."""
    while (descriptor := os.open(os.devnull, os.O_RDWR)) <= 2:
        pass
    os.close(descriptor)
    for stream in filter(None, (sys.stdout, sys.stderr)):
        stream.reconfigure(errors="backslashreplace")


def _guarded(main):
    """The exit code. Whoever has stopped reading what is printed has seen enough and is told nothing."""
    try:
        code, told = _outcome(main)
        if told:
            say(one_line(told))
    except BrokenPipeError:
        code = NO_READER
    except OSError:  # of stderr: nobody can be told
        code = BAD
    _let_go_of_what_cannot_be_written()
    return code


def _outcome(main):
    """(exit code, what is said at the end)"""
    try:
        code = _exit_code(main)
        _flush()
        return code, None
    except BrokenPipeError:
        raise
    except ResultError as error:
        return BAD, str(error)
    except AlreadyTold:
        return BAD, None
    except OSError as error:
        return BAD, _words(error)
    except (KeyboardInterrupt, Interrupted) as stopped:
        return INTERRUPTED, f"interrupted{'; ' if str(stopped) else ''}{stopped}"


def _exit_code(main):
    try:
        return main() or OK
    except SystemExit as end:  # of --help and of wrong options
        return end.code or OK


def _flush():
    if sys.stdout:
        sys.stdout.flush()


def _words(error):
    if error.filename is not None:
        return f"{os.fsdecode(error.filename)}: {error.strerror}"
    try:
        _flush()
    except OSError as of_stdout:
        return f"what is printed cannot be written: {of_stdout.strerror}"
    return error.strerror or str(error)


def _let_go_of_what_cannot_be_written():
    """Python would try again at its end, and complain."""
    for stream in filter(None, (sys.stdout, sys.stderr)):
        try:
            stream.flush()
        except OSError:
            with open(os.devnull, "w", encoding="utf-8") as nowhere:
                os.dup2(nowhere.fileno(), stream.fileno())
            stream.flush()
