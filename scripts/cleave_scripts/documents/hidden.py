"""What the paper leaves open: what holds under which choice, and the choice that fits its Table 1 best."""
import dataclasses
import statistics

from cleave_scripts.documents.stored import need
from cleave_scripts.measurements import hidden_choices
from cleave_scripts.results.errors import ResultError
from cleave_scripts.results.names import title
from cleave_scripts.results.paper import COMBINATIONS, PAPER, SCENES, load_paper_table1
from cleave_scripts.table import text
from cleave_scripts.table.cells import Cell, SceneTable, Times
from cleave_scripts.table.formats import format_markdown
from cleave_scripts.table.timing_table import mark_lowest

MADE_BY = "scripts/hidden_choices"
CELLS, CLAIMS, FIT = ((f"hidden_choices{name}.csv", MADE_BY) for name in ("", "_claims", "_fit"))
DEFAULT = {choice: str(value) for choice, value in dataclasses.asdict(hidden_choices.DEFAULT).items()}
CHOICES = tuple(DEFAULT)
TITLES = ("n_max", "bodies numbered", "bfs", "mr", "mix")
PAPERS_LOGS = str(hidden_choices.PAPERS_LOGS)
SHOWN = 3  # settings of the best


def _counts(rows):
    """'holds in 12 of 72' of rows of one claim and way of judging; empty where it was not judged."""
    sums = {name: sum(int(row[name]) for row in rows) for name in ("holds", "fails", "cannot_tell")}
    if not any(sums.values()):
        return ""
    unclear = f", {sums['cannot_tell']} undecided" if sums["cannot_tell"] else ""
    return f"{sums['holds']} of {sum(sums.values())}{unclear}"


def claims(stored):
    rows = need(stored.table(*CLAIMS), "claims", "holds")
    lines = []
    for claim, part in dict.fromkeys((row["claim"], row["row"]) for row in rows):
        mine = [row for row in rows if (row["claim"], row["row"]) == (claim, part)]
        lines.append([claim, part, *(_counts([row for row in mine if row["by"] == by]) for by in ("cut", "time"))])
    return text.table(["claim", "part", "holds by interface rows in", "holds by time in"], lines)


def _fits(stored, by):
    return [row for row in need(stored.table(*FIT), "fits", "mean") if row["by"] == by]


def _is(row, setting):
    return all(row[name] == setting[name] for name in CHOICES)


def _fit_line(name, row):
    return [name, *(f"`{row[choice]}`" if choice != "max_bodies" else row[choice] for choice in CHOICES),
            *(f"{float(row[column]):.2f}" for column in ("mean", *SCENES))]


def fit(stored):
    """The best settings by time and by cut, and the defaults."""
    lines = []
    for by, name in (("time", "time"), ("cut", "interface rows")):
        rows = _fits(stored, by)
        lines += [_fit_line(f"{name}, {place} of {len(rows)}", row) for place, row in enumerate(rows[:SHOWN], 1)]
        lines += [_fit_line(f"{name}, {place} of {len(rows)}: the defaults", row) for place, row in enumerate(rows, 1)
                  if _is(row, DEFAULT)]
    head = text.table(["by", *TITLES, "mean", *map(title, SCENES)], lines)
    return f"{head}\n\n{_choice_means(stored)}"


def _choice_means(stored):
    """Of every choice the mean correlation by time over the settings that make it."""
    rows, parts = _fits(stored, "time"), []
    for choice, words in zip(CHOICES, TITLES):
        values = dict.fromkeys(row[choice] for row in rows)
        means = [f"`{value}` {statistics.mean(float(row['mean']) for row in rows if row[choice] == value):.2f}"
                 for value in values]
        parts.append(f"{words}: {', '.join(means)}")
    return f"Mean correlation by time of all settings with a choice: {'; '.join(parts)}."


def _timed(stored, setting, cell):
    """The row of the paper's cell in a setting."""
    scene, partitioner, refiner = cell
    wanted = {"scene": scene, "refiner": refiner, "solver": PAPER["solver"], "max_bodies": setting["max_bodies"],
              "body_order": setting["body_order"], "partitioner": setting.get(partitioner, partitioner), "logs": PAPERS_LOGS}
    found = next((row for row in stored.table(*CELLS) if all(row[name] == value for name, value in wanted.items())), None)
    if found is None:
        raise ResultError(f"stored hidden_choices.csv has no row of {', '.join(wanted.values())}; {MADE_BY} makes it anew")
    return found


def best_table(stored):
    """Table 1 of the setting that fits the paper's best by time."""
    setting, paper = _fits(stored, "time")[0], load_paper_table1()
    tables = []
    for scene in SCENES:
        cells = []
        for names in COMBINATIONS:
            row = _timed(stored, setting, (scene, *names))
            cells.append(Cell(*names, Times(float(row["t_s_ms"]), float(row["t_pr_ms"])), Times(*paper[(scene, *names)]),
                              int(row["steps"])))
        mark_lowest(scene, cells, paper)
        tables.append(SceneTable(scene, cells[0].ok, "1", PAPER["solver"], cells))
    said = ", ".join(f"{words} `{setting[choice]}`" for choice, words in zip(CHOICES, TITLES))
    return format_markdown(tables, [f"Setting: {said}. Made on {stored.origin(CELLS[0])}."])


def thresholds(stored):
    """What tau_mr does to mr on Large Rock Pile, beside the paper."""
    paper, setting = load_paper_table1(), dict(DEFAULT)
    scene, lines = "large_rock_pile", []
    plain = float(_timed(stored, setting, (scene, "mindp", "none"))["t_s_ms"])
    for mr in dict.fromkeys(row["mr"] for row in _fits(stored, "time")):
        row = _timed(stored, {**setting, "mr": mr}, (scene, "mr", "none"))
        lines.append([f"`{mr}`", text.number(float(row["interface_rows"])), text.number(float(row["parts"])),
                      text.number(float(row["t_s_ms"]) / plain)])
    theirs = paper[scene, "mr", "none"][0] / paper[scene, "mindp", "none"][0]
    return text.table(["Large Rock Pile, without refiner", "interface rows", "parts", "t_s over that of mindp"],
                      [*lines, ["the paper", "", "", text.number(theirs)]])


BLOCKS = {"hidden_claims": claims, "hidden_fit": fit, "hidden_table1": best_table, "hidden_thresholds": thresholds}
