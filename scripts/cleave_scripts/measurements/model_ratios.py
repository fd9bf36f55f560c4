"""Modelled over measured t_s on two threads: t_s_model_p2_ms of one-thread rows over t_s_ms of two-thread rows that solved
the same problem with the same partition."""
import dataclasses
import statistics

from cleave_scripts.results.errors import ResultError
from cleave_scripts.table.cells import MOST_WAITING
from cleave_scripts.table.timing_table import waiting_share

KEY = ("problem_hash", "partitioner", "refiner", "solver")
MODEL = "t_s_model_p2_ms"
NEEDED = (*KEY, "threads", "status", "t_s_ms", MODEL)


@dataclasses.dataclass
class Comparison:
    pairs: list  # (one-thread row, two-thread row)
    waited: int  # pairs left out because one of the solves waited for a core
    alone: int  # rows without a partner


def solved_rows(rows, threads, path):
    """{key: row} of the rows that were solved on so many threads; a cell counts once."""
    kept = [row for row in rows if row["status"] == "ok" and row.integer("threads") == threads]
    if not kept:
        raise ResultError(f"{path}: no row of status ok with threads {threads}")
    found = {}
    for row in kept:
        key = tuple(row[column] for column in KEY)
        if key in found:
            raise ResultError(f"{row.path}, line {row.line}: this problem and combination stand already in "
                              f"{found[key].path}, line {found[key].line}")
        found[key] = row
    return found


def compare(one, two):
    """The pairs of what solved_rows found on one and on two threads."""
    both = [(row, two[key]) for key, row in one.items() if key in two]
    pairs = [pair for pair in both if not any(waiting_share([row]) > MOST_WAITING for row in pair)]
    return Comparison(pairs, len(both) - len(pairs), len(one) + len(two) - 2 * len(both))


def ratios(pairs, columns):
    """{values of the columns: p2 / t_s of every pair}"""
    groups = {}
    for one, two in pairs:
        ratio = _positive(one, MODEL) / _positive(two, "t_s_ms")
        groups.setdefault(tuple(one[column] for column in columns), []).append(ratio)
    return groups


def _positive(row, column):
    value = row.number(column)
    if not value > 0:
        raise ResultError(f"{row.path}, line {row.line}: {column} is '{row[column]}', expected more than 0")
    return value


def quartiles(values):
    return statistics.quantiles(values, n=4, method="inclusive") if len(values) > 1 else 3 * values
