"""What the README promises of how the program ends, and what is wrong with how it did."""
import re
import signal

DONE, BAD_INPUT, ROWS_FAILED, CHECK_FAILED, INTERRUPTED = 0, 1, 2, 3, 130
# What verify says of a good file, before a bad one, what a command says that takes over the lock of a killed one, and of
# options that are not needed.
INFORMATION = re.compile(r": problem of .*, hash [0-9a-f]{16}$|: left by process \d+ .*; taken over$|^--.* changes? nothing: |"
                         r"^--\w+ all leaves out ")
PROGRESS = re.compile(r"^\w+: step \d+ of \d+, \d+ s, about \d+ s to go$")  # of what had taken long
# What libraries say whose start, before the program's own, lacks memory: GnuTLS, which HDF5 brings in and which goes on
# without; and OpenMP's begins its one line with an empty one.
LIBRARY_START = re.compile(r"^Error in GnuTLS initialization: .*\n|^\n(?=libgomp: )", re.MULTILINE)
ALARMS = ("Traceback (most recent call last)", "AddressSanitizer", "ThreadSanitizer", "runtime error:", "terminate called",
          "Assertion", "HDF5-DIAG", "free(): invalid", "malloc():", "double free")


def fault(ending, allowed):
    """A few words that name the kind of fault, or None: the exit code is one of those allowed, what it says is orderly."""
    if ending.hung:
        return "hangs"
    if ending.code < 0:
        return f"crashes with {_signal_name(-ending.code)}"
    for alarm in ALARMS:
        if alarm in ending.err or alarm in ending.out:
            return f"prints '{alarm}'"
    if ending.code not in allowed:
        return f"exit code {ending.code}"
    return _fault_of_refusal(ending) if ending.code == BAD_INPUT else None


def _fault_of_refusal(ending):
    """One line, of signs that can be printed. What was said of good files, of progress and by libraries before stays said."""
    said = LIBRARY_START.sub("", ending.err).splitlines()
    lines = [line for line in said if not INFORMATION.search(line) and not PROGRESS.search(line)]
    if len(lines) != 1:
        return "no error line" if not lines else "several error lines"
    return None if lines[0].isprintable() else "error line with control characters"


def _signal_name(number):
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"
