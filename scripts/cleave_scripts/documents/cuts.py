"""What partitioners and refiners cost, and what the open choices of the method do to the cut."""
import math
import tomllib

from cleave_scripts.documents.stored import need
from cleave_scripts.measurements import cut_ratios, karger_trials
from cleave_scripts.results.names import title
from cleave_scripts.results.paper import DATA
from cleave_scripts.table import text

CUTS = tomllib.loads((DATA / "cuts.toml").read_text(encoding="utf-8"))
CHOICES = {choice["name"]: tuple(choice["options"]) for choice in CUTS["choice"]}
ABLATION = ("ablation.csv", "scripts/ablation")
KARGER = ("karger.csv", "scripts/karger")
SPEED = ("partition_benchmark.json", "scripts/benchmark_partitioners")
TIMED = CUTS["timed"]


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


def _graphs(stored):
    return cut_ratios.by_graph(need(stored.benchmark(*SPEED), "the benchmark of partitioners", "name", "cpu_time"))


def _title(graph, cells):
    row = next(iter(cells.values()))
    return f"{graph.replace('_', ' ')}: {row['bodies']:.0f} bodies, {row['edges']:.0f} edges"


def partition_speed(stored):
    graphs, names = _graphs(stored), list(TIMED)
    times = [[_title(graph, cells), *(text.number(cells[name]["cpu_time"]) if name in cells else "" for name in names)]
             for graph, cells in graphs.items()]
    cut = [[graph.replace("_", " "), *(_cut(cells.get(name)) for name in names)] for graph, cells in graphs.items()]
    return (f"CPU time in µs, medians, one core; {stored.origin(SPEED[0])}:\n\n" + text.table(["", *TIMED.values()], times) +
            "\n\nInterface rows, of ten seeds the least without a part of more than 30 bodies (-: all had one):\n\n" +
            text.table(["", *TIMED.values()], cut))


def _cut(row):
    cut = cut_ratios.cut_of(row)
    return "" if row is None else "-" if cut is None else f"{cut:.0f}"


def partition_ratios(stored):
    """Against METIS and SCOTCH."""
    graphs = _graphs(stored)
    found = {words: cut_ratios.ratios(graphs, name) for name, words in TIMED.items()}
    lines = [[words, text.number(ratio.rows), f"{text.number(ratio.worst_rows)} ({ratio.worst_graph.replace('_', ' ')})",
              text.number(ratio.speed), text.number(ratio.least_speed), text.number(ratio.growth)]
             for words, ratio in found.items() if ratio]
    least, most = cut_ratios.TIMED_BODIES
    return (f"Against the best of METIS and SCOTCH, all strategies, ten seeds each ({stored.origin(SPEED[0])}); speed on "
            f"graphs of {least} to {most} bodies:\n\n" +
            text.table(["", "rows, geometric mean", "rows, worst graph", "times as fast as METIS recursive", "at least",
                        "time a body, 100000 over 1000"], lines) +
            "\n\nWhat was asked of them, and what holds:\n\n" +
            text.table(["", "holds"], [[asked, "yes" if holds else "no"] for asked, holds in cut_ratios.targets(graphs)]))


def _karger_line(scene, cells):
    def of(key):
        return f"{cells[key].rows:.0f} / {text.number(cells[key].t_pr_ms)}"

    needed = (karger_trials.trials_needed(cells, refiner) for refiner in karger_trials.REFINERS)
    rivals_ms, karger_ms = karger_trials.lowest_totals(cells)
    return [title(scene), *(of(rival) for rival in karger_trials.RIVALS),
            *(of((trials, "fm")) for trials in karger_trials.TRIALS), of((karger_trials.BISECTION, "fm")),
            *("more" if math.isinf(trials) else trials for trials in needed), text.number(rivals_ms), text.number(karger_ms)]


def karger(stored):
    rows = need(stored.table(*KARGER), "random contraction", "trials")
    lines = [_karger_line(scene, karger_trials.cells_of(rows, scene)) for scene in dict.fromkeys(row["scene"] for row in rows)]
    rivals = ["+".join(rival) for rival in karger_trials.RIVALS]
    steps = len({row["step"] for row in rows})
    return (f"Interface rows / t_pr in ms, means over {steps} recorded steps of a scene (`{KARGER[1]}`; "
            f"{stored.origin(KARGER[0])}); then the least trials that cut no more rows than {rivals[0]}, and the lowest t_pr + "
            f"t_s of {' and '.join(rivals)} and of karger with any number of trials, one thread, `schur`, ms. By least cuts: "
            f"`karger_method` {karger_trials.BISECTION}, one trial:\n\n" +
            text.table(["scene", *rivals, *(f"karger+fm, {trials}" for trials in karger_trials.TRIALS),
                        "by least cuts+fm, 1", "trials needed, none", "trials needed, fm", "lowest total", "of karger"], lines))


BLOCKS = {"ablation": ablation, "ablation_facts": ablation_facts, "partition_speed": partition_speed,
          "partition_ratios": partition_ratios, "karger": karger}
