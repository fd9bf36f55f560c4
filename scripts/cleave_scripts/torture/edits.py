"""Edits of steps.csv, which `verify` finds: by the checksums, or where those were written again by what it recomputes."""
import csv
import io
import shutil

from cleave_scripts.torture.cell_edits import changed_cell
from cleave_scripts.torture.directories import rewrite_checksums
from cleave_scripts.torture.endings import BAD_INPUT, CHECK_FAILED
from cleave_scripts.torture.recomputable import is_recomputable, least_change


def _row_removed(dice, rows):
    del rows[dice.randrange(1, len(rows))]


def _rows_removed(dice, rows):
    del rows[dice.randrange(1, len(rows)):]


def _row_doubled(dice, rows):
    row = dice.randrange(1, len(rows))
    rows.insert(dice.randrange(1, len(rows) + 1), list(rows[row]))


def _rows_swapped(dice, rows):
    first, second = dice.sample(range(1, len(rows)), 2)
    rows[first], rows[second] = rows[second], rows[first]


def _columns_swapped(dice, rows):
    """With their names: the order of columns is part of the schema."""
    first, second = dice.sample(range(len(rows[0])), 2)
    for row in rows:
        row[first], row[second] = row[second], row[first]


def _names_swapped(dice, rows):
    first, second = dice.sample(range(len(rows[0])), 2)
    rows[0][first], rows[0][second] = rows[0][second], rows[0][first]


def _column_removed(dice, rows):
    place = dice.randrange(len(rows[0]))
    for row in rows:
        del row[place]


def _column_doubled(dice, rows):
    place = dice.randrange(len(rows[0]))
    for row in rows:
        row.append(row[place])


def _name_misspelt(dice, rows):
    place = dice.randrange(len(rows[0]))
    rows[0][place] += dice.choice(["x", " ", "_"])


def _cell_removed(dice, rows):
    del rows[dice.randrange(1, len(rows))][-1]


STRUCTURE = {
    "a row removed": _row_removed,
    "the last rows removed": _rows_removed,
    "a row doubled": _row_doubled,
    "rows swapped": _rows_swapped,
    "columns swapped": _columns_swapped,
    "names of columns swapped": _names_swapped,
    "a column removed": _column_removed,
    "a column doubled": _column_doubled,
    "a name misspelt": _name_misspelt,
    "a cell removed": _cell_removed,
}
TEXTS = {
    "only x": lambda dice, text: "x",
    "only x in a line": lambda dice, text: "x\n",
    "nothing": lambda dice, text: "",
    "only the header": lambda dice, text: text.partition("\n")[0] + "\n",
    "cut short": lambda dice, text: text[:dice.randrange(1, len(text))],
    "a mark of byte order": lambda dice, text: "\ufeff" + text,
    "other ends of lines": lambda dice, text: text.replace("\n", "\r\n"),
    "an empty line": lambda dice, text: text.replace("\n", "\n\n", 1),
    "a zero byte": lambda dice, text: text[:50] + "\x00" + text[50:],
    "an open quote": lambda dice, text: text.replace(",", ',"', 1),
}
CELL = "a cell changed"


def trial(trial):
    command = trial.random.choice(sorted(trial.material.undisturbed))
    directory = trial.directory / "out"
    shutil.copytree(trial.material.undisturbed[command].directory, directory)
    edit = trial.random.choice([*STRUCTURE, *TEXTS, *[CELL] * 20])
    can_be_found, what, where = _apply(trial.random, command, edit, directory / "steps.csv")
    rewritten = trial.random.random() < 0.75 and rewrite_checksums(directory)
    trial.note(f"steps.csv of {command}: {edit}, {where}" + (", checksums written again" if rewritten else ""))
    ending = trial.finish(trial.start("verify", "out"))
    if ending.code == 0:
        if rewritten and not can_be_found:
            trial.count("unlisted")
        else:
            trial.find(f"verify: believes {what} in steps.csv of {command}", where)
    elif trial.check(ending, "verify", (BAD_INPUT, CHECK_FAILED)):
        _check_named(trial, ending, edit == CELL and rewritten and can_be_found, where)


def _apply(dice, command, edit, path):
    """(whether it can be found without checksums, what, where), the last two in words"""
    text = path.read_text(encoding="utf-8")
    if edit in TEXTS:
        path.write_text(TEXTS[edit](dice, text), encoding="utf-8", newline="")
        return True, edit, "the file"
    rows = list(csv.reader(io.StringIO(text)))
    told = True, edit, "the table"
    if edit == CELL:
        told = _change_cell(dice, command, rows)
    else:
        STRUCTURE[edit](dice, rows)
    written = io.StringIO()
    csv.writer(written, lineterminator="\n").writerows(rows)
    path.write_text(written.getvalue(), encoding="utf-8", newline="")
    return told


def _change_cell(dice, command, rows):
    line, place = dice.randrange(1, len(rows)), dice.randrange(len(rows[0]))
    row, column, old = dict(zip(rows[0], rows[line])), rows[0][place], rows[line][place]
    rows[line][place] = changed_cell(dice, old, least_change(column, row))
    where = f"line {line + 1}, {column} was '{old}', is '{rows[line][place]}'"
    return is_recomputable(command, column, row), f"{CELL} ({column})", where


def _check_named(trial, ending, by_line, where):
    """The file at least; of a cell that is recomputed also the line."""
    told = ending.out + ending.err
    line = where.partition(",")[0]
    if "steps.csv" not in told:
        trial.find("verify: does not name steps.csv", told)
    elif by_line and line not in told:
        trial.find("verify: does not name the row that was changed", f"{where}\n{told}")
    else:
        trial.count("noticed")
