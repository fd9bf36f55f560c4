"""What has to hold of an output directory at any moment: what stands under a final name is whole and can be read."""
import csv
import hashlib
import io
import json

import h5py

from cleave_scripts.torture.guarded import Unreadable, guarded

CHECKSUMS, LOCK, UNFINISHED = "checksums", "cleave.lock", ".part"


def final_files(directory):
    """What stands under a final name, if there is a directory at all."""
    found = directory.rglob("*") if directory.is_dir() else ()
    return sorted(path for path in found if path.is_file() and UNFINISHED not in path.suffixes and path.name != LOCK)


def broken_files(directory):
    """(name, why) of each that cannot be read whole."""
    for path in final_files(directory):
        try:
            if why := _fault(path):
                yield path.name, why
        except (OSError, ValueError, Unreadable) as error:
            yield path.name, f"cannot be read: {error}"


def _fault(path):
    if path.suffix == ".h5":
        guarded(read_everything, path)
        return None
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".json":
        json.loads(text)
    return fault_of_lines(text) if path.suffix == ".csv" else None


def read_everything(path):
    """{name: bytes} of all datasets and attributes of an HDF5 file. Call it guarded."""
    with h5py.File(path) as file:
        found = {}

        def visit(name, item):
            found.update({f"{name}@{key}": repr(value) for key, value in item.attrs.items()})
            found[name] = (str(item.dtype), item.shape, item[()].tobytes()) if isinstance(item, h5py.Dataset) else None

        visit("", file)
        file.visititems(visit)
        return found


def fault_of_lines(text):
    """None where every line that is there is whole and has as many cells as the header."""
    if text and not text.endswith("\n"):
        return "the last line is not whole"
    rows = list(csv.reader(io.StringIO(text)))
    wrong = [number for number, cells in enumerate(rows, 1) if len(cells) != len(rows[0])]
    return f"line {wrong[0]} has {len(rows[wrong[0] - 1])} cells, the header {len(rows[0])}" if wrong else None


def state(directory):
    """What the manifest says of the run; None without one."""
    try:
        return json.loads((directory / "manifest.json").read_text(encoding="utf-8")).get("state")
    except (OSError, ValueError, AttributeError):
        return None


def rewrite_checksums(directory):
    """As sha256sum writes them, of the files that are named now. Whether there are any."""
    path = directory / CHECKSUMS
    if not path.is_file():
        return False
    names = [line.split(maxsplit=1)[1].lstrip("*") for line in path.read_text().splitlines() if line.strip()]
    path.write_text("".join(f"{hashlib.sha256((directory / name).read_bytes()).hexdigest()}  {name}\n"
                            for name in names if (directory / name).is_file()))
    return True


def experiment_rows(directory):
    """The rows of steps.csv without the machine's columns, which two runs of an experiment share digit for digit."""
    manifest = json.loads((directory / "manifest.json").read_text(encoding="utf-8"))
    machine = {column["name"] for column in manifest["columns"] if column["machine"]} | {"problem_file"}
    with open(directory / "steps.csv", newline="", encoding="utf-8") as file:
        return [{name: cell for name, cell in row.items() if name not in machine} for row in csv.DictReader(file)]
