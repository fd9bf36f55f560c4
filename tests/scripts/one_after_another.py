"""One command of scripts/ with one set of words after another, in this process: a new interpreter for each would take a tenth
of a second, and the tests of bad input give a thousand of them. Words: the command; standard input: a list of lists of words,
in JSON. Prints a list of [exit code, what was said on stderr]."""
import json
import os
import runpy
import sys
import tempfile
import traceback


def ending_of(command, words):
    """The exit code, as the interpreter makes it of the command's end."""
    sys.argv = [command, *words]
    try:
        runpy.run_path(command, run_name="__main__")
    except SystemExit as end:
        return end.code or 0
    except BaseException:  # pylint: disable=broad-except
        traceback.print_exc()
        return 1
    return 0


def said(command, words):
    """[exit code, what was written to stderr]"""
    with tempfile.TemporaryFile() as kept:
        ours = os.dup(2)
        os.dup2(kept.fileno(), 2)
        try:
            code = ending_of(command, words)
            sys.stderr.flush()
        finally:
            os.dup2(ours, 2)
            os.close(ours)
        kept.seek(0)
        return code, kept.read().decode(errors="replace")


def main():
    command = sys.argv[1]
    sys.path[0] = os.path.dirname(command)
    endings = [said(command, words) for words in json.load(sys.stdin)]
    print("\n" + json.dumps(endings))  # below what the command printed


if __name__ == "__main__":
    main()
