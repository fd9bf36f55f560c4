"""`cleave sweep` for stand-ins: the cells of a campaign as the program itself expands them,
each run by the stand-in as `cleave run`.

STAND_IN_REAL in the environment is the program. A cell that ended with exit code 0 or 2 is kept when the campaign is run again.
"""
import csv
import io
import os
import pathlib
import subprocess
import sys

COLUMNS = ("cell", "number", "round", "status", "reason", "log", "arguments", "label")


def write_index(campaign, cells):
    """cells: dictionaries with what is not `ok`, of the first round and without a label."""
    campaign.mkdir(parents=True, exist_ok=True)
    with open(campaign / "index.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        for number, cell in enumerate(cells, 1):
            writer.writerow({"number": number, "round": 1, "status": "ok", "reason": "-", "log": "-", "arguments": "--scene=x",
                             "label": "-", **cell})


def _expanded(spec):
    command = [os.environ["STAND_IN_REAL"], "sweep", spec, "--out", "/nonexistent", "--dry-run"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.stderr.write(done.stderr)
        sys.exit(done.returncode)
    return [{name: cell[name] for name in ("cell", "arguments", "label")} for cell in csv.DictReader(io.StringIO(done.stdout))]


def _run(campaign, cell):
    """Its row of the index."""
    words = [text for word in cell["arguments"].split(" ") for text in word.partition("=")[::2] if text]
    directory = campaign / "cells" / cell["cell"]
    command = [sys.argv[0], "run", *words, "--out", str(directory)]
    done = subprocess.run(command, stderr=subprocess.PIPE, text=True, check=False)
    row = {**cell, "round": cell["cell"].rpartition("_r")[2], "log": "-" if done.returncode in (0, 2) else "0" * 64}
    if done.returncode == 130:
        sys.exit(130)
    if done.returncode in (0, 2):
        return row | {"status": "ok" if done.returncode == 0 else "not_converged"}
    reason = (done.stderr.strip().splitlines() or [f"ended with {done.returncode}"])[-1]
    return row | {"status": "timeout" if done.returncode == 124 else "crashed", "reason": reason}


def answer():
    """Ends as the campaign ends, where one is asked for."""
    if sys.argv[1] != "sweep":
        return
    campaign = pathlib.Path(sys.argv[sys.argv.index("--out") + 1])
    cells, rows = _expanded(sys.argv[2]), []
    if "--dry-run" in sys.argv:
        sys.exit(0)
    for cell in cells:
        kept = campaign / "cells" / cell["cell"] / "manifest.json"
        if kept.is_file() and "--force" not in sys.argv:
            rows.append({**cell, "round": cell["cell"].rpartition("_r")[2]})
            continue
        rows.append(_run(campaign, cell))
    write_index(campaign, rows)
    sys.exit(0 if all(row.get("status", "ok") == "ok" for row in rows) else 2)
