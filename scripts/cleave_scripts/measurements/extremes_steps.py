"""What scripts/extremes measured, a row a step, and the table of it."""
import re

from cleave_scripts.results.campaign import campaign_cells
from cleave_scripts.results.errors import ResultError
from cleave_scripts.results.steps import load_steps
from cleave_scripts.results.whole_file import write_rows
from cleave_scripts.table import text

NUMBER = r"[0-9]+(?:\.[0-9]+)?(?:e-?[0-9]+)?"
NAME = re.compile(rf"ratio_(?P<mass_ratio>{NUMBER})_(?P<scene>.+)_cfm_(?P<cfm>{NUMBER})_seed_(?P<seed>[0-9]+)")
COLUMNS = ("status", "factorizations")
WRITTEN = ("mass_ratio", "scene", "cfm", "seed", *COLUMNS)


def read(paths):
    """One dictionary a step."""
    steps = []
    for cell in (cell for path in paths for cell in campaign_cells(path)):
        match = NAME.fullmatch(cell.name)
        if match is None:
            raise ResultError(f"{cell.directory}: not a run of scripts/extremes")
        if not cell.ran:
            raise ResultError(f"{cell.name}: {cell.status}, {cell.reason}")
        steps += [match.groupdict() | _measured(row) for row in load_steps(cell.directory / "steps.csv", COLUMNS)[0]]
    return steps


def _measured(row):
    row.integer("factorizations")  # has to be one
    return {name: row[name] for name in COLUMNS}


def cells(steps):
    """{(ratio, scene): {cfm: steps}}"""
    table = {}
    for step in steps:
        table.setdefault((step["mass_ratio"], step["scene"]), {}).setdefault(step["cfm"], []).append(step)
    return table


def most_allowed(ratio, cfm):
    """Factorisations of a step; None where no number is set."""
    if float(cfm) == 0:
        return None
    return 40 if float(ratio) <= 1e3 else 70


def holds(step):
    allowed = most_allowed(step["mass_ratio"], step["cfm"])
    return step["status"] == "ok" and (allowed is None or int(step["factorizations"]) <= allowed)


def _describe(steps):
    counts = [int(step["factorizations"]) for step in steps]
    failed = sum(step["status"] != "ok" for step in steps)
    text = f"{sum(counts) / len(counts):.0f} / {max(counts)}"
    return text + (f", {failed} not solved" if failed else "")


def markdown(table):
    cfms = sorted({cfm for found in table.values() for cfm in found}, key=float, reverse=True)
    lines = [[ratio, scene, sum(map(len, found.values())), *(_describe(found[cfm]) if cfm in found else "-" for cfm in cfms)]
             for (ratio, scene), found in sorted(table.items(), key=lambda item: (float(item[0][0]), item[0][1]))]
    return text.table(["mass ratio", "scene", "steps", *(f"cfm {cfm}" for cfm in cfms)], lines)


def judge(paths, csv_file=None):
    """Prints the table, writes the steps where a file is named, and returns the exit code of a command."""
    steps = read(paths)
    if not steps:
        raise ResultError("no rows of a run of scripts/extremes")
    if csv_file:
        write_rows(csv_file, WRITTEN, steps)
    print(markdown(cells(steps)))
    good = all(map(holds, steps))
    print("every step solved within the number of factorisations" if good else "not every step holds")
    return 0 if good else 3
