"""Table 1 beside the paper's, what it says, and an excerpt of what scripts/reproduce prints."""
import pathlib
import statistics
import subprocess

from cleave_scripts.documents.stored import need
from cleave_scripts.results.about import setup_columns
from cleave_scripts.results.errors import ResultError
from cleave_scripts.results.names import title
from cleave_scripts.results.paper import PAPER, SCENES, load_paper_table1
from cleave_scripts.table import text
from cleave_scripts.table.formats import format_markdown, format_text
from cleave_scripts.table.timing_table import build_tables

DATA = ("full", "scripts/reproduce --measure-every 10")
EXCERPT_SCENE = "rock_pile"
CHECK = pathlib.Path(__file__).resolve().parents[2] / "check_matrix"
FULL_COMBINATIONS = ("mindp", "mix", "bfs")


def _tables(stored):
    setup = setup_columns(*(run.manifest for run in stored.runs(*DATA)))
    return build_tables(stored.rows(*DATA), load_paper_table1(), [("solver", PAPER["solver"])], setup)


def table1(stored):
    header = [f"Made on {stored.origin('full')}."]
    return format_markdown(_tables(stored), header)


def excerpt(stored):
    tables = [table for table in _tables(stored) if table.scene == EXCERPT_SCENE]
    lines = format_text(need(tables, EXCERPT_SCENE), [])
    heading, *rest = lines[lines.index("\n\n") + 2:].splitlines()
    first, second, *_, last = _checked(stored)
    return "```\n" + "\n".join([heading, *rest[:5], "...", *rest[14:], "", first, second, "...", last]) + "\n```"


def _checked(stored):
    """What scripts/check_matrix prints, which scripts/reproduce ends with."""
    done = subprocess.run([CHECK, stored.path(*DATA)], capture_output=True, text=True, check=False)
    if done.returncode not in (0, 3):
        raise ResultError(done.stderr.strip())
    return done.stdout.splitlines()


def _lowest(table, side):
    """Name and total of the lowest combination of a scene, ours or the paper's."""
    cells = [cell for cell in table.cells if getattr(cell, f"{side}_lowest")]
    if not cells:
        return "-"
    return f"{cells[0].partitioner}+{cells[0].refiner}, {text.number(getattr(cells[0], side).total_ms)}"


def _gain(cells, name, than):
    return text.percent(1 - cells[name].ours.total_ms / cells[than].ours.total_ms)


def _scene_line(table):
    cells = {(cell.partitioner, cell.refiner): cell for cell in table.cells}
    refined = [cells[name, "fm"].ours.total_ms for name in FULL_COMBINATIONS]
    return [
        table.title, _lowest(table, "ours"), _lowest(table, "paper"),
        _gain(cells, ("mindp", "fm"), ("mindp", "none")), _gain(cells, ("mix", "fm"), ("mindp", "none")),
        text.percent(max(refined) / min(refined) - 1),
        text.number(max(cell.ours.total_ms for cell in table.cells) / min(cell.ours.total_ms for cell in table.cells))
    ]


def table1_facts(stored):
    tables, rows = _tables(stored), stored.rows(*DATA)
    lines = text.table(
        ["scene", "lowest total, ms", "the paper's", "fm takes off mindp", "mix+fm below mindp+none",
         "mindp, mix, bfs with fm within", "slowest / fastest"], map(_scene_line, tables))
    return "\n".join([lines, "", _exactness(rows), "", _partitioning(tables), "", _stalls(rows)])


def _exactness(rows):
    good = [row for row in rows if row["status"] == "ok"]
    largest = max(row.number("residual_m_per_s") for row in good)
    spread = max(row.number("velocity_spread_m_per_s") for row in good)
    solved = f"All {len(rows)}" if len(good) == len(rows) else f"{len(good)} of {len(rows)}"
    return (f"{solved} rows are exact: their largest residual is {text.number(largest)} m/s, and on no step do the "
            f"velocities of two combinations differ by more than {text.number(2 * spread)} m/s.")


def _partitioning(tables):
    cells = [cell for table in tables for cell in table.cells if cell.ok]
    ours = [1000 * cell.ours.t_pr_ms for cell in cells]
    gains = [cell.paper.t_pr_ms / cell.ours.t_pr_ms for cell in cells]
    gains = [gain for gain in gains if gain == gain]
    return (f"Partitioning and refining takes {text.number(min(ours), 2)} to {text.number(max(ours), 2)} µs a step, "
            f"{text.number(min(gains), 2)} to {text.number(max(gains), 2)} times less than the paper's "
            f"(median {text.number(statistics.median(gains), 2)}).")


def _stalls(rows):
    shares = []
    for scene in SCENES:
        mine = [row for row in rows if row["scene"] == scene]
        if mine:
            share = sum(row.integer("fallbacks") > 0 for row in mine) / len(mine)
            shares.append(f"{text.percent(share)} of the rows of {title(scene)}")
    return ("Block pivoting, which the paper's solver rests on, stalls and hands over to the interior point on "
            f"{text.listed(shares)}.")


BLOCKS = {"table1": table1, "excerpt": excerpt, "table1_facts": table1_facts}
