"""Reads steps.csv, what `cleave run` writes into an output directory.

Every error is a ResultError whose one line names the file, and the column or line where there is one.
"""
import csv
import dataclasses
import io
import pathlib

from cleave_scripts.results.campaign import campaign_cells, is_campaign
from cleave_scripts.results.errors import ResultError
from cleave_scripts.results.manifest import load_manifest


# The judge's limit of an exact answer (kExactLimit in solver/step_problem.h): residuals up to this many times
# max(1, largest free velocity) m/s.
EXACT_LIMIT = 1e-9


class Row(dict):
    """One line of steps.csv: text by column, and where it stands."""

    def __init__(self, values, path, line):
        super().__init__(values)
        self.path = path
        self.line = line

    def number(self, column):
        """The value of a column as float; nan and inf are numbers here."""
        try:
            return float(self[column])
        except ValueError:
            raise ResultError(f"{self.path}, line {self.line}: column {column} is '{self[column]}', "
                              "expected a number") from None

    def integer(self, column):
        try:
            return int(self[column])
        except ValueError:
            raise ResultError(f"{self.path}, line {self.line}: column {column} is '{self[column]}', "
                              "expected a whole number") from None


@dataclasses.dataclass
class Run:
    """One output directory."""

    steps_path: pathlib.Path
    rows: list
    manifest: dict  # empty where there is no manifest.json
    notes: list  # what a reader of the numbers has to know, one line each


def find_steps_files(paths):
    """The steps.csv of every path: a file, an output directory, a campaign, or a directory of output directories."""
    found = []
    for path in map(pathlib.Path, paths):
        if path.is_file():
            here = [path]
        elif path.is_dir():
            here = _steps_files_in(path)
        else:
            raise ResultError(f"{path}: no such file or directory")
        if not here:
            raise ResultError(f"{path}: neither steps.csv nor */steps.csv in it, and no campaign with a run that is there")
        found += [file for file in here if file not in found]
    return found


def _steps_files_in(directory):
    if (directory / "steps.csv").is_file():
        return [directory / "steps.csv"]
    if not is_campaign(directory):
        return sorted(directory.glob("*/steps.csv"))
    return [path for cell in campaign_cells(directory) if (path := cell.directory / "steps.csv").is_file()]


def load_steps(path, required=()):
    """Rows of one steps.csv and notes about it. A last line that was not finished is left out and noted."""
    path = pathlib.Path(path)
    try:
        text = path.read_bytes().decode("utf-8")
    except OSError as error:
        raise ResultError(f"{path}: {error.strerror}") from None
    except UnicodeDecodeError:
        raise ResultError(f"{path}: not a text file") from None
    if not text:
        raise ResultError(f"{path}: empty file, not even a header")
    notes = []
    complete, newline, rest = text.rpartition("\n")
    if rest:
        notes.append(f"{path}: the last line was not finished and is left out")
    if not newline:
        raise ResultError(f"{path}: the header line was not finished")

    reader = csv.reader(io.StringIO(complete + newline))
    header, rows = None, []
    try:
        for cells in reader:
            if not cells or (header is None and cells[0].startswith("#")):
                continue
            if header is None:
                header = cells
                _check_header(path, header, required)
            elif len(cells) != len(header):
                raise ResultError(
                    f"{path}, line {reader.line_num}: {len(cells)} values, the header has {len(header)}")
            else:
                rows.append(Row(zip(header, cells), path, reader.line_num))
    except csv.Error as error:
        raise ResultError(f"{path}, line {reader.line_num}: {error}") from None
    if header is None:
        raise ResultError(f"{path}: no header line")
    if not rows:
        notes.append(f"{path}: no rows")
    return rows, notes


def _check_header(path, header, required):
    missing = [column for column in required if column not in header]
    if missing:
        raise ResultError(f"{path}: missing column {', '.join(missing)}")
    twice = sorted({column for column in header if header.count(column) > 1})
    if twice:
        raise ResultError(f"{path}: column {', '.join(twice)} stands twice in the header")


def load_runs(paths, required=()):
    """All runs below the given files and directories."""
    runs = []
    for steps_path in find_steps_files(paths):
        rows, notes = load_steps(steps_path, required)
        manifest = load_manifest(steps_path.parent)
        if manifest.get("state", "complete") != "complete":
            notes.append(
                f"{steps_path}: not all steps are there, the state of the run is {manifest['state']}")
        runs.append(Run(steps_path, rows, manifest, notes))
    return runs
