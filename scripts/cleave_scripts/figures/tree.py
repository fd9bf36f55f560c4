"""Reads a tree of output directories into data frames. What cannot be read becomes a message."""
import dataclasses
import math
import pathlib

import pandas

from cleave_scripts.ladder.cells import CAMPAIGN as LADDER_CAMPAIGN
from cleave_scripts.measurements import accuracy, motion_of_solvers
from cleave_scripts.results.about import setup_columns
from cleave_scripts.results.campaign import run_files_below
from cleave_scripts.results.errors import ResultError
from cleave_scripts.results.manifest import load_manifest
from cleave_scripts.results.steps import Row, load_steps
from cleave_scripts.table.timing_table import NEEDED, READ_TOO

REQUIRED = ("scene", "step", "partitioner", "refiner", "solver", "status")
TEXT_COLUMNS = ("run_id", "scene", "partitioner", "refiner", "solver", "strategy", "kernel", "friction",
                "status", "status_reason", "auto_reason", "problem_hash", "solution_hash", "state_hash",
                "problem_file")
TABLE_COLUMNS = (*NEEDED, *READ_TOO)
NUMBERS = ("t_", "factor", "interface_", "residual_", "part_", "rows", "bodies", "step", "seed", "threads",
           "repeat_count")  # what columns begin with that are numbers even where no value is one
NOT_MEASURED = ("", "-", "nan", "inf", "-inf")
PARTS = ("options", "option_about", "build", "machine", "result")  # of a manifest, each an object


TRADEOFF_FILE, MOTIONS_FILE = "tradeoff.csv", "tradeoff_motion.csv"
CLAIMS_FILE, COUNTS = "hidden_choices_claims.csv", ("holds", "fails", "cannot_tell")


class NoData(Exception):
    """Something cannot be drawn; the text says what is missing."""


@dataclasses.dataclass
class Experiment:
    """One output directory."""

    name: str  # its path below the tree; of a cell of a campaign, that of the campaign and its label
    rows: pandas.DataFrame  # numbers are floats, nan where not measured
    table_rows: list  # the same rows as Table 1 wants them
    manifest: dict  # empty where there is none


@dataclasses.dataclass
class Tree:
    directory: pathlib.Path
    experiments: list
    ladder: object  # data frame of ladder.csv, or None
    claims: object  # of hidden_choices_claims.csv, or None
    accuracy: object  # problems of tradeoff.csv (measurements/accuracy.py), or None
    motions: object  # of tradeoff_motion.csv (measurements/motion_of_solvers.py), or None
    messages: list  # what the reader of the report has to know, one line each


def read_tree(directory):
    """Everything below a directory: any number of steps.csv, and one ladder.csv; in it, what is known of hidden choices and of
    the price of accuracy."""
    directory = pathlib.Path(directory)
    if not directory.is_dir():
        raise ResultError(f"{directory}: no such directory")
    tree = Tree(directory, [], None, None, None, None, [])
    found = run_files_below(directory, "steps.csv", lambda error: tree.messages.append(f"{error}; its cells are left out"))
    steps = [(name, path) for name, path in found if LADDER_CAMPAIGN not in path.parts]  # whose runs ladder.csv judges
    ladders = sorted(directory.rglob("ladder.csv"))
    if not steps and not ladders:
        raise ResultError(f"{directory}: neither steps.csv nor ladder.csv in it or below")
    for name, path in steps:
        experiment = _attempt(tree, lambda path, tree: _read_experiment(path, tree, name), path)
        if experiment is not None:
            tree.experiments.append(experiment)
    if ladders:
        tree.ladder = _attempt(tree, _read_ladder, ladders[0])
        tree.messages += [f"{path}: left out, the ladder is taken from {ladders[0]}" for path in ladders[1:]]
    claims = directory / CLAIMS_FILE
    if claims.is_file():
        tree.claims = _attempt(tree, _read_claims, claims)
    tradeoff = directory / TRADEOFF_FILE
    if tradeoff.is_file():
        tree.accuracy = _attempt(tree, _read_accuracy, tradeoff)
    motions = directory / MOTIONS_FILE
    if motions.is_file():
        tree.motions = _attempt(tree, _read_motions, motions)
    return tree


def _attempt(tree, read, path):
    try:
        return read(path, tree)
    except ResultError as error:
        tree.messages.append(f"{error}; the file is left out")
        return None


def _read_experiment(path, tree, name):
    rows, notes = load_steps(path, REQUIRED)
    tree.messages += notes
    manifest = _manifest(path, tree)
    if not rows:
        return None
    frame = to_frame(rows, path, tree.messages)
    kept = _after_skip(frame, manifest)
    if len(kept) < len(frame):
        tree.messages.append(f"{path}: {len(frame) - len(kept)} rows before --skip are left out")
    columns = (*TABLE_COLUMNS, *setup_columns(manifest))
    table_rows = [
        Row({column: rows[index][column] for column in columns if column in rows[index]}, path, rows[index].line)
        for index in kept.index
    ]
    return Experiment(name, kept.reset_index(drop=True), table_rows, manifest) if len(kept) else None


def _manifest(path, tree):
    try:
        manifest = load_manifest(path.parent)
    except ResultError as error:
        tree.messages.append(f"{error}; the machine and the options are unknown")
        return {}
    if not manifest:
        tree.messages.append(f"{path.parent}: no manifest.json, so the machine and the options are unknown")
    elif manifest.get("state", "complete") != "complete":
        tree.messages.append(f"{path}: not all steps are there, the state of the run is {manifest['state']}")
    return {key: _texts(value) if key in PARTS else value for key, value in manifest.items()}


def _texts(part):
    """A part of a manifest with texts only, whatever a damaged one holds."""
    return {key: str(value) for key, value in part.items() if value is not None} if isinstance(part,
                                                                                               dict) else {}


def _after_skip(frame, manifest):
    skip = pandas.to_numeric(manifest.get("options", {}).get("skip", "0"), errors="coerce")
    return frame[~(frame["step"] < skip)]


def to_frame(rows, path, messages):
    """Numbers become floats; nan where not measured: nan, inf, -, and -1 in all but energies."""
    frame = pandas.DataFrame(rows)
    for column in frame.columns.difference(TEXT_COLUMNS):
        values = pandas.to_numeric(frame[column], errors="coerce")
        missing = frame[column].str.lower().isin(NOT_MEASURED)
        wrong = values.isna() & ~missing
        if wrong.any() and (wrong | missing).all() and not column.startswith(NUMBERS):
            continue  # a parameter whose values are words, which some rows do not have
        if wrong.any():
            first = rows[wrong.idxmax()]
            messages.append(
                f"{path}, line {first.line}: column {column} is '{first[column]}', expected a number; "
                f"{wrong.sum()} such values are left out")
        frame[column] = values.astype(float).replace([math.inf, -math.inf], math.nan)
        if not column.endswith("_j"):
            frame[column] = frame[column].mask(frame[column] == -1)
    return frame


def _read_ladder(path, tree):
    rows, notes = load_steps(path, ("rung", "parameter", "value", "solver", "status"))
    tree.messages += notes
    return pandas.DataFrame(rows) if rows else None


def _read_accuracy(path, tree):
    """Problems of what scripts/tradeoff wrote."""
    rows, notes = load_steps(path, accuracy.NEEDED)
    tree.messages += notes
    kept = accuracy.of_whole_steps(rows)
    if len(kept) < len(rows):
        tree.messages.append(f"{path}: {len(rows) - len(kept)} of {len(rows)} rows are of steps that do not have every solve "
                             "and are left out")
    found = accuracy.problems(kept)
    if not all(accuracy.EXACT in problem.times_ms for problem in found):
        raise ResultError(f"{path}: no solver {accuracy.EXACT}")
    return found or None


def _read_motions(path, tree):
    """Motions of what scripts/tradeoff wrote."""
    rows, notes = load_steps(path, motion_of_solvers.NEEDED)
    tree.messages += notes
    return motion_of_solvers.motions(rows) or None


def _read_claims(path, tree):
    """Frame of what scripts/hidden_choices wrote; counts are numbers."""
    rows, notes = load_steps(path, ("claim", "row", "by", "max_bodies", "order", *COUNTS))
    tree.messages += notes
    if not rows:
        return None
    frame = pandas.DataFrame(rows)
    for column in ("max_bodies", *COUNTS):
        frame[column] = [row.integer(column) for row in rows]
    return frame


def need(frame, *columns):
    """The rows that have all these columns; NoData naming the column that is missing or never measured."""
    if frame.empty:
        raise NoData("no row with status ok")
    for column in columns:
        if column not in frame.columns:
            raise NoData(f"column {column} is missing")
        frame = frame[frame[column].notna()]
        if frame.empty:
            raise NoData(f"no row with status ok has a value in column {column}")
    return frame
