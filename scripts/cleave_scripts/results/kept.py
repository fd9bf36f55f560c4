"""The one way to run a cell if it is not done: a run of cleave, a cell of the ladder, a stage of scripts/reference.

A cell has a `label` and `arguments`. A store knows what was made before: its find(cell) gives (result, words), where the
result is None if the cell has to be run and the words then say why what is there does not count; its add(cell, result)
notes what was made now.
"""
import json
import os
import pathlib
import threading

from cleave_scripts.results.errors import ResultError
from cleave_scripts.results.manifest import load_manifest, machine
from cleave_scripts.results.run_key import difference, manifest_key, place_difference, program_key


def keep_or_run(store, cell, run, force=False, tell=lambda text: None):
    """The result of a cell: the one that is there, else that of run(cell)."""
    result, words = (None, "") if force else store.find(cell)
    if result is not None:
        tell(f"{cell.label} is kept{words}")
        return result
    if words:
        tell(f"{cell.label}: {words}")
    result = run(cell)
    store.add(cell, result)
    return result


class RunDirectories:
    """Output directories of `cleave run`, which notes in its manifest what it made. Cells have a `directory`; a result is the
    exit code that the run had: 0, or 2 where some of its cells failed."""

    def __init__(self):
        self.keys = {}

    def open(self, program, cells, force):
        """Refuses, before any of them runs, arguments that the program does not take, and what must not be overwritten."""
        for cell in cells:
            self.keys[cell] = program_key(program, [*cell.arguments, "--out", cell.directory])
            if not force:
                self.find(cell)

    def find(self, cell):
        wanted = self.keys[cell]
        try:
            manifest = load_manifest(cell.directory)
        except ResultError:
            return None, ""
        files = ["steps.csv"] + ["motion.h5"] * ("--record-motion" in cell.arguments)
        if manifest.get("state") != "complete" or not all((cell.directory / name).is_file() for name in files):
            return None, ""
        reason = self._reason(cell, manifest, wanted)
        if reason:
            return None, f"the results in {cell.directory} are not kept: {reason}"
        result = manifest["result"]
        return (0 if result["rows_ok"] == result["rows"] else 2,
                f": {result['rows_ok']} of {result['rows']} rows ok, made {manifest['utc_end']} by {machine(manifest)}; "
                "--force runs it again")

    def _reason(self, cell, manifest, wanted):
        """Why what is there is not kept. What this build made on this machine by another command is not overwritten."""
        kept, made_by = manifest_key(manifest), manifest["argv"][1:]
        reason = difference(kept, wanted)
        is_of_here = place_difference(kept, wanted) is None
        if reason and is_of_here and _without_place(made_by) != _without_place(cell.arguments):
            raise ResultError(f"{cell.directory} holds the results of: {' '.join(made_by)}; give another --out, or --force to "
                              "overwrite")
        return reason

    def add(self, cell, result):
        """Nothing is left to note."""


def _without_place(arguments):
    """The command less where it writes, which does not change what it computes."""
    kept, skip = [], False
    for argument in arguments:
        if not skip and argument not in ("--out", "--force"):
            kept.append(argument)
        skip = argument == "--out"
    return kept


class Journal:
    """A line a cell in a file, for what leaves no manifest. Lines of another build or machine do not count, nor those that were
    noted beside other values of `noted`."""

    def __init__(self, path, key, noted=None):
        self.path, self.key, self.noted = pathlib.Path(path), key, noted or {}
        self.lock = threading.Lock()
        self.finished = {}
        for entry in self._entries():
            if self.is_valid(entry):
                self.finished[entry["arguments"]] = entry

    def _entries(self):
        text = self.path.read_text(encoding="utf-8", errors="replace") if self.path.exists() else ""
        self.is_torn = not text.endswith("\n") and text != ""  # a line that was being written when all was stopped
        for line in text.splitlines():
            try:
                entry = json.loads(line)
            except ValueError:
                continue
            if isinstance(entry, dict) and {"key", "arguments", "result", *self.noted} <= entry.keys():
                yield entry

    def is_valid(self, entry):
        same = all(entry[name] == value for name, value in self.noted.items())
        return same and difference(entry["key"], self.key) is None

    def find(self, cell):
        entry = self.finished.get(" ".join(cell.arguments))
        return (entry["result"] if entry else None), ""

    def add(self, cell, result):
        entry = {"key": self.key, **self.noted, "arguments": " ".join(cell.arguments), "result": result}
        with self.lock:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            with self.path.open("a", encoding="utf-8") as file:
                file.write("\n" * self.is_torn + json.dumps(entry) + "\n")
                file.flush()
                os.fsync(file.fileno())
            self.is_torn = False
