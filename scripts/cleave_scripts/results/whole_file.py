"""Files appear under their names when they are whole and on the disk: written aside, synced and renamed."""
import contextlib
import csv
import io
import os
import pathlib

from cleave_scripts.results.errors import ResultError


def part_name(path):
    """Where a file lies until it is whole."""
    return path.with_name(path.name + ".part")


@contextlib.contextmanager
def written_aside(path):
    """Where the body has to write the file, `path` with ".part"; what stood under its name stays until the body is done."""
    path = pathlib.Path(os.path.realpath(path))
    part = part_name(path)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        yield part
        _sync(part)
        os.replace(part, path)
        _sync(path.parent)
    except BrokenPipeError:
        raise
    except OSError as error:
        raise ResultError(f"{path}: cannot be written: {error.strerror or error}") from None
    finally:
        with contextlib.suppress(OSError):
            part.unlink(missing_ok=True)


def _sync(path):
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def write_bytes(path, content):
    with written_aside(path) as part:
        part.write_bytes(content)


def write_text(path, text):
    write_bytes(path, text.encode("utf-8"))


def write_rows(path, columns, rows):
    """A CSV file of dictionaries; what they hold besides the columns is left out."""
    text = io.StringIO(newline="")
    writer = csv.DictWriter(text, columns, extrasaction="ignore", lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    write_text(path, text.getvalue())
