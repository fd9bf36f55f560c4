"""What partitioners and refiners cost, and what the open choices of the method do to the cut."""
import tomllib

from cleave_scripts.documents.stored import need
from cleave_scripts.results.paper import DATA
from cleave_scripts.table import text

CUTS = tomllib.loads((DATA / "cuts.toml").read_text(encoding="utf-8"))
CHOICES = {choice["name"]: tuple(choice["options"]) for choice in CUTS["choice"]}
ABLATION = ("ablation.csv", "scripts/ablation")
SPEED = ("partition_benchmark.json", "scripts/benchmark_partitioners")
TIMED = CUTS["timed"]
GRAPHS = {"pile_200": "200 bodies, 353 edges", "pile_600": "600 bodies, 1059 edges"}


def _by_cell(rows):
    """{scene: {combination: {choice: interface rows}}}"""
    found = {}
    for row in rows:
        name = f"{row['partitioner']}+{row['refiner']}"
        found.setdefault(row["scene"], {}).setdefault(name, {})[row["choice"]] = float(row["interface_rows"])
    return found


def ablation_tables(rows):
    """One table a scene; an empty cell is the same as the default."""
    parts = []
    for scene, combinations in _by_cell(rows).items():
        mine = next(row for row in rows if row["scene"] == scene)
        lines = [[name] + [f"{found[choice]:.0f}" if choice == "default" or found[choice] != found["default"] else ""
                           for choice in CHOICES] for name, found in combinations.items()]
        parts.append(f"{scene}, {mine['bodies']} bodies, {mine['steps']} steps:\n\n" +
                     text.table(["", *CHOICES], lines))
    return "\n\n".join(parts)


def ablation(stored):
    return f"{stored.origin(ABLATION[0])}.\n\n" + ablation_tables(need(stored.table(*ABLATION), "the ablation"))


def _change(found, choice):
    change = round(100 * (found[choice] / found["default"] - 1))
    return f"{change:+d} %" if change else ""


def ablation_facts(stored):
    """The change of the cut under a choice, for the combinations it is about."""
    cells = _by_cell(need(stored.table(*ABLATION), "the ablation"))
    lines = [[choice["name"], f"`{name}`", *(_change(found[name], choice["name"]) for found in cells.values())]
             for choice in CUTS["choice"] for name in choice["about"]]
    return "Interface rows against the default:\n\n" + text.table(["choice", "", *cells], lines)


def partition_speed(stored):
    entries = {entry["name"]: entry for entry in stored.benchmark(*SPEED) if entry.get("aggregate_name") == "median"}
    lines, cut = [], []
    for graph, title in GRAPHS.items():
        row = [entries[f"{graph}/{name}_median"] for name in TIMED]
        lines.append([title, *(text.number(entry["cpu_time"]) for entry in row)])
        cut.append([title, *(f"{entry['interface_rows']:.0f}" for entry in row)])
    names = list(TIMED.values())
    return (f"CPU time in µs, medians, one core; {stored.origin(SPEED[0])}:\n\n" + text.table(["", *names], lines) +
            "\n\nInterface rows:\n\n" + text.table(["", *names], cut))


BLOCKS = {"ablation": ablation, "ablation_facts": ablation_facts, "partition_speed": partition_speed}
