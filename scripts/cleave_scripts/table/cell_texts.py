"""What the formats of Table 1 have in common: numbers, notes and the order of rows."""
import math

from cleave_scripts.results.rows import FAR_NS
from cleave_scripts.table.cells import MOST_FAR, MOST_WAITING, Cell

GAP = "-"
WAITED = "‡"
CELL_HELP = "t_s solve, t_pr partition + refine, mean ms a step; ratio = ours / paper of t_s + t_pr."


def format_number(value, decimals=2):
    return GAP if math.isnan(value) else f"{value:.{decimals}f}"


def format_ratio(value):
    return GAP if math.isnan(value) else f"{value:#.3g}"


def scene_notes(tables):
    """What has to be known before comparing: runs of another size than the paper's, and disturbed ones."""
    notes = [
        f"{table.title} is not the paper's run: {table.differs}; its ratios compare different problems."
        for table in tables if table.differs
    ]
    waited = [
        f"{table.title} {cell.partitioner} {cell.refiner} {100 * cell.waiting:.0f} %" for table in tables
        for cell in table.cells if cell.waited
    ]
    if waited:
        notes.append(f"{WAITED} The solves waited more than {100 * MOST_WAITING:.0f} % of t_s for a core, so "
                     f"other programs are in these times: {', '.join(waited)}.")
    notes += [
        f"{table.title}: for {100 * table.far:.0f} % of t_s the threads were on cores far apart, where they may take twice as "
        f"long: core_round_trip_ns was {FAR_NS} or more." for table in tables if table.far > MOST_FAR
    ]
    return notes


def pair(times, t_s_decimals, t_pr_decimals):
    if math.isnan(times.total_ms):
        return GAP
    return f"{times.t_s_ms:.{t_s_decimals}f} + {times.t_pr_ms:.{t_pr_decimals}f}"


def combinations(tables):
    """All combinations of the tables; one that only some have stands beside its partitioner's others."""
    names = dict.fromkeys((cell.partitioner, cell.refiner) for table in tables for cell in table.cells)
    partitioners = list(dict.fromkeys(partitioner for partitioner, _ in names))
    return sorted(names, key=lambda name: partitioners.index(name[0]))


def across(tables):
    """For every combination its cells, one a scene."""
    names = combinations(tables)
    by_table = [{(cell.partitioner, cell.refiner): cell for cell in table.cells} for table in tables]
    return [[cells.get(name) or Cell(*name) for cells in by_table] for name in names]
