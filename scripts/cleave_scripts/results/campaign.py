"""What `cleave sweep` leaves in a directory: its index, and the output directories of its cells."""
import csv
import dataclasses
import io
import pathlib

from cleave_scripts.results.errors import ResultError

INDEX, CELLS_FOLDER = "index.csv", "cells"
NEEDED = ("cell", "number", "round", "status", "reason", "log", "arguments", "label")


@dataclasses.dataclass(frozen=True)
class Cell:
    """One that the campaign's spec has now; of earlier ones others may lie beside them."""
    name: str  # its label where the spec gives one; with the round where there are several
    directory: pathlib.Path  # of its run
    status: str
    reason: str
    ran: bool  # whether its process came to its end
    options: dict  # {name: text} as cleave run got them; a flag is True


def is_campaign(directory):
    return (pathlib.Path(directory) / INDEX).is_file()


def campaign_cells(directory):
    """In the order of the spec."""
    rows = [row for row in index_rows(directory) if row["number"] != "0"]
    in_rounds = any(row["round"] != "1" for row in rows)
    return [_cell(pathlib.Path(directory), row, in_rounds) for row in rows]


def index_rows(directory):
    """Rows of the index, texts by column, those of earlier specs too (number 0)."""
    path = pathlib.Path(directory) / INDEX
    try:
        rows = list(csv.DictReader(io.StringIO(path.read_text(encoding="utf-8"))))
    except (OSError, ValueError, csv.Error) as error:
        raise ResultError(f"{path}: {error}") from None
    if not rows or any(row.get(column) is None for row in rows for column in NEEDED):
        raise ResultError(f"{path}: not the index of a campaign of this version")
    return rows


def _cell(directory, row, in_rounds):
    name = (row["cell"] if row["label"] == "-" else row["label"]) + f"_round_{row['round']}" * in_rounds
    return Cell(name, directory / CELLS_FOLDER / row["cell"], row["status"], row["reason"], row["log"] == "-",
                options_of(row["arguments"]))


def options_of(arguments):
    """{name: text} of the words of a cell, --name=text or --name."""
    pairs = (word.removeprefix("--").partition("=") for word in arguments.split(" "))
    return {name: value if sign else True for name, sign, value in pairs}


def refuse(error):
    raise error


def run_files_below(directory, file_name, tell=refuse):
    """(name, path) of a file of every output directory, in the order of the names: its path below the directory, or that of its
    campaign and what the campaign calls it. Cells that a campaign has no more are left out. tell(error): of a campaign that
    cannot be read."""
    directory, found, campaigns = pathlib.Path(directory), [], set()
    for path in directory.rglob(file_name):
        campaign = _campaign_of(path, directory)
        if campaign is None:
            found.append((str(path.parent.relative_to(directory)), path))
        else:
            campaigns.add(campaign)
    for campaign in sorted(campaigns):
        try:
            cells = campaign_cells(campaign)
        except ResultError as error:
            tell(error)
            continue
        place = campaign.relative_to(directory)
        found += [(str(place / cell.name), path) for cell in cells if (path := cell.directory / file_name).is_file()]
    return sorted(found)


def _campaign_of(path, directory):
    """The campaign, not above the directory, to a cell of which the file belongs; None where there is none."""
    folder = path.parent.parent
    is_cell = path.parent != directory and folder != directory and folder.name == CELLS_FOLDER and is_campaign(folder.parent)
    return folder.parent if is_cell else None
