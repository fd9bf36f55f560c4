"""What options stand for: numbers, names, lists of them, and places to read from and to write to.

A type says what is wrong with a value in words that follow the name of the option: "is '0', expected ...".
"""
import argparse
import math
import os
import pathlib
import re
import tempfile

from cleave_scripts.results.names import nearest
from cleave_scripts.results.whole_file import part_name

MOST_COUNT = 999_999_999
MOST_SEED = 2**64 - 1
MOST_THREADS = 1024  # as in the program


def _wrong(text, expected, word="is"):
    return argparse.ArgumentTypeError(f"{word} '{text}', expected {expected}")


def whole_number(least, most=MOST_COUNT):

    def parse(text):
        if not re.fullmatch(r"[0-9]{1,20}", text) or not least <= int(text) <= most:
            raise _wrong(text, parse.allowed)
        return int(text)

    parse.allowed = f"a whole number from {least} to {most}"
    return parse


def number_above(least, most):

    def parse(text):
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not least < value <= most:
            raise _wrong(text, parse.allowed)
        return value

    parse.allowed = f"a number above {least:g}, at most {most:g}"
    return parse


def one_of(known):

    def parse(text):
        if text not in known:
            raise _wrong(text, f"one of {','.join(known)}{nearest(text, known)}")
        return text

    return parse


def list_of(kind):
    """The type of a comma separated list of what another type reads; the first that is wrong is named."""

    def parse(text):
        return [_item(kind, item) for item in text.split(",")]

    return parse


def _item(kind, text):
    try:
        return kind(text)
    except argparse.ArgumentTypeError as error:
        raise argparse.ArgumentTypeError(f"{re.sub('^is ', 'has ', str(error))}, comma separated") from None


def some_of(known):
    """Names of a list, comma separated, each once and in the order of the list."""

    def name(text):
        if text not in known:
            raise _wrong(text, f"some of {','.join(known)}{nearest(text, known)}", "has")
        return text

    def parse(text):
        chosen = [name(item) for item in text.split(",")]
        return [item for item in known if item in chosen]

    return parse


def filled(text):
    """Any text but an empty one."""
    if not text:
        raise _wrong(text, "a value")
    return text


def input_path(text):
    """A file or directory that is there."""
    if not text or not os.path.exists(text):
        raise _wrong(text, "a file or directory: no such file or directory")
    return pathlib.Path(text)


def input_file(text):
    if not text or not os.path.isfile(text):
        raise _wrong(text, "a file to read: " + ("it is a directory" if os.path.isdir(text) else "no such file"))
    return pathlib.Path(text)


def input_directory(text):
    if not text or not os.path.isdir(text):
        raise _wrong(text, "a directory to read: " + ("it is a file" if os.path.exists(text) else "no such directory"))
    return pathlib.Path(text)


def output_directory(text):
    """A directory that can be written to, or that can be made. Nothing is made yet."""
    reason = _why_not_writable(pathlib.Path(text)) if text else "no name"
    if reason:
        raise _wrong(text, f"a directory to write to: {reason}")
    return pathlib.Path(text)


def output_file(text):
    """A file that can be written, as a whole; nothing is written yet."""
    reason = _why_no_file(pathlib.Path(text)) if text else "no name"
    if reason:
        raise _wrong(text, f"a file to write: {reason}")
    return pathlib.Path(text)


def _why_no_file(path):
    path = pathlib.Path(os.path.realpath(path))
    if path.exists() and not path.is_file():
        return f"{path} is no regular file"
    return _why_not_writable(path.parent, (part_name(path).name,))


def _why_not_writable(directory, to_be_made=()):
    """In words; None where a file can be made there, or in what has to be made first. to_be_made: names below it."""
    there, names = directory, list(to_be_made)
    while not os.path.lexists(there):
        names.append(there.name)
        there = there.parent
    if not there.is_dir():
        return f"{there} is no directory"
    longest = os.pathconf(there, "PC_NAME_MAX")
    if any(len(os.fsencode(name)) > longest for name in names):
        return f"a name of more than {longest} bytes"
    return _try_to_write(there)


def _try_to_write(directory):
    """With a file that has no name."""
    try:
        with tempfile.TemporaryFile(dir=directory):
            return None
    except OSError as error:
        return f"{directory}: {error.strerror}"
