"""What `cleave sweep` and `cleave collect` take for very many cells, and what processes of a campaign do besides solving."""
import os
import shutil
import statistics
import subprocess
import time

from cleave_scripts.campaigns.sweep import Campaign
from cleave_scripts.results.campaign import INDEX, campaign_cells, index_rows
from cleave_scripts.results.errors import ResultError, last_line
from cleave_scripts.results.steps import load_steps

# The smallest run there is: a box that falls, one step, one row.
CELL = {"scene": "ladder_free", "boxes": 1, "steps": 1, "measure-every": 1, "repeats": 1, "solver": "exact",
        "partitioner": "mindp", "refiner": "none"}
COLUMNS = ("what", "cells", "round", "seconds", "peak_memory_mb")
EXPAND, RESUME, WITHOUT_INDEX, COLLECT = "expand", "resume", "resume_without_index", "collect"
PROCESSES, RUNS, SOLVES = "paper_processes", "paper_runs", "paper_solves"
WORDS = {
    EXPAND: "`cleave sweep --dry-run`, nothing there",
    RESUME: "`cleave sweep`, all complete",
    WITHOUT_INDEX: "the same without its index",
    COLLECT: "`cleave collect`",
}


def campaign_of(cells, out):
    return Campaign("many", CELL | {"seed": list(range(1, cells + 1))}, out)


def measured(words, options):
    """(seconds, peak memory in MB) of a program that ends well."""
    start_s = time.monotonic()
    with subprocess.Popen([*map(str, words)], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                          **options) as process:
        said = process.stderr.read()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        raise ResultError(f"{' '.join(map(str, words[:2]))} stopped with exit code {process.returncode}: {last_line(said)}")
    return time.monotonic() - start_s, usage.ru_maxrss * 1024 / 1e6


def costs(program, campaign, cells, rounds, out):
    """A row a command and round, the commands in turn."""
    rows = []
    for number in range(1, rounds + 1):
        for what in WORDS:
            seconds, memory_mb = _cost(program, campaign, what, out)
            rows.append(dict(zip(COLUMNS, (what, cells, number, seconds, memory_mb))))
    return rows


def _cost(program, campaign, what, out):
    if what == COLLECT:
        (out / "collected").mkdir(exist_ok=True)
        return measured([program, "collect", campaign.out, "--out", out / "collected" / "results.csv", "--force"], {})
    if what == EXPAND:
        shutil.rmtree(out / "nothing", ignore_errors=True)
        campaign = Campaign(campaign.name, campaign.spec, out / "nothing")
    if what == WITHOUT_INDEX:
        (campaign.out / INDEX).unlink()
    with campaign.command(program, *["--dry-run"] * (what == EXPAND)) as (words, options):
        return measured(words, options)


def times_of(directory):
    """Rows with the seconds of all processes of a campaign, of the runs in them,
    and of every solve and partition they timed."""
    rows = [row for row in index_rows(directory) if row["number"] != "0"]
    seconds = {PROCESSES: sum(float(row["process_s"]) for row in rows), RUNS: sum(float(row["run_s"]) for row in rows),
               SOLVES: sum(map(_solves_s, campaign_cells(directory)))}
    return [dict(zip(COLUMNS, (what, len(rows), 1, value, "nan"))) for what, value in seconds.items()]


def _solves_s(cell):
    rows = load_steps(cell.directory / "steps.csv", ("repeat_count", "t_s_ms", "t_pr_ms"))[0]
    return sum(row.integer("repeat_count") * (row.number("t_s_ms") + max(0, row.number("t_pr_ms"))) for row in rows) / 1e3


def median(rows, what, column):
    return statistics.median(float(row[column]) for row in rows if row["what"] == what)


def lines_of(rows):
    for what, words in WORDS.items():
        cells = next(row["cells"] for row in rows if row["what"] == what)
        yield f"{words}: {cells} cells in {median(rows, what, 'seconds'):.2f} s, {median(rows, what, 'peak_memory_mb'):.0f} MB"
    if any(row["what"] == SOLVES for row in rows):
        share = 1 - median(rows, SOLVES, "seconds") / median(rows, PROCESSES, "seconds")
        yield f"campaign of the paper: {100 * share:.1f} % of its processes' time is not in timed solves and partitions"
