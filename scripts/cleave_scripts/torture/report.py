"""The result: counts by kind of trial, as JSON and as a page."""
import json
import os
import platform

from cleave_scripts.results.whole_file import write_text
from cleave_scripts.table import text
from cleave_scripts.torture.registry import KINDS
from cleave_scripts.torture.tally import COUNTS

ABOUT = {kind.name: kind.about for kind in KINDS}
TABLE = ("trials", "programs", "judged", "above", "kills", "restarts", "findings")


def write(out, tally, frame):
    """Also while trials are being made, so that whoever is killed leaves the counts of then."""
    write_text(out / "torture.json", as_json(tally, frame))
    write_text(out / "torture.md", as_page(tally, frame))


def as_json(tally, frame):
    """frame: command, program, seed, time, ... in the order in which they are told."""
    kinds = {name: {**{count: counts[count] for count in COUNTS}, "seconds": round(tally.seconds[name], 1),
                    "found": dict(tally.found[name].most_common())} for name, counts in tally.counts.items()}
    total = {name: tally.total(name) for name in COUNTS}
    return json.dumps({**frame, "total": total, "kinds": kinds, "not_run": tally.not_run}, indent=1) + "\n"


def as_page(tally, frame):
    lines = ["# Hostile trials", "", *(f"- {name.replace('_', ' ')}: {value}" for name, value in frame.items()), "",
             text.table(["kind", *(COUNTS[name] for name in TABLE)],
                        [*([kind, *(counts[name] for name in TABLE)] for kind, counts in tally.counts.items()),
                         *([kind, f"NOT RUN: {why}", *[""] * (len(TABLE) - 1)] for kind, why in tally.not_run.items()),
                         ["all", *map(tally.total, TABLE)]]), ""]
    lines += [f"- `{kind}`: {ABOUT[kind]}. {_rest(counts)}" for kind, counts in tally.counts.items()]
    found = [[kind, what, number] for kind, all in tally.found.items() for what, number in all.most_common()]
    lines += ["", text.table(["kind", "finding", "times"], found) if found else "No findings."]
    return "\n".join(lines) + "\n"


def _rest(counts):
    """What the table has no column for."""
    return ", ".join(f"{counts[name]} {words}" for name, words in COUNTS.items() if name not in TABLE and counts[name])


def machine():
    with open("/proc/cpuinfo", encoding="utf-8", errors="replace") as file:
        models = [line.partition(":")[2].strip() for line in file if line.startswith("model name")]
    return f"{models[0] if models else platform.machine()}, {os.cpu_count()} cores, Linux {platform.release()}"
