"""The stored results that the documents speak of."""
import csv
import functools
import json
import pathlib

from cleave_scripts.results.errors import ResultError
from cleave_scripts.results.manifest import load_manifest
from cleave_scripts.results.programs import load_benchmark
from cleave_scripts.results.steps import load_runs


class NoResults(Exception):
    """Nothing is stored; the text says where it would stand and what makes it."""


class Stored:
    """What is under results/. A part that is not there is NoResults."""

    def __init__(self, root):
        self.root = pathlib.Path(root)
        self.gaps = {}  # what was asked for below results/ and is not there, not whole, or not of a known and clean origin: why

    def has(self, name, made_by):
        """Whether a file or directory is there; where it is not, that is a gap."""
        if (self.root / name).exists():
            return True
        self.gaps[name] = f"not stored, {made_by} makes it"
        return False

    def path(self, name, made_by):
        if not self.has(name, made_by):
            raise NoResults(f"Nothing is stored yet: `{made_by}` makes `results/{name}`.")
        return self.root / name

    @functools.cache
    def runs(self, name, made_by):
        """What a run has to say of itself, such as that it was stopped, is a gap."""
        runs = load_runs([self.path(name, made_by)])
        for run in runs:
            if run.notes:
                told = (note.removeprefix(f"{run.steps_path}: ") for note in run.notes)
                self.gaps[str(run.steps_path.relative_to(self.root))] = "; ".join(told)
        return runs

    def rows(self, name, made_by):
        return [row for run in self.runs(name, made_by) for row in run.rows]

    @functools.cache
    def table(self, name, made_by):
        """Rows of a CSV file that is no steps.csv, as dictionaries of text."""
        with open(self.path(name, made_by), newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    @functools.cache
    def benchmark(self, name, made_by):
        return load_benchmark(self.path(name, made_by))

    @functools.cache
    def provenance(self):
        """{file below results/: what made it}"""
        path = self.root / "provenance.json"
        return json.loads(path.read_text(encoding="utf-8"))["files"] if path.exists() else {}

    def origin(self, name):
        """'AMD EPYC, 2 cores, commit 0123456789' of a directory of runs, or of a file with provenance or a directory of
        such."""
        manifests = [load_manifest(path.parent) for path in sorted((self.root / name).rglob("manifest.json"))]
        known = self.provenance()
        within = [entry for file, entry in known.items() if file.startswith(f"{name}/")]
        entries = manifests or within or [known[file] for file in (name,) if file in known]
        texts = dict.fromkeys(
            f"{entry['machine']['cpu_model']}, {entry['machine']['cores']} cores, commit "
            f"{entry['build']['git_hash'][:10]}" for entry in entries)
        if not texts:
            self.gaps[name] = "machine and commit not recorded"
        elif any(entry["build"].get("git_dirty") != "false" for entry in entries):
            self.gaps[name] = "made by a build with local changes or without a commit"
        return "; ".join(texts) or self.gaps[name]


def need(rows, what, *columns):
    """rows, where there are any, and where they have these columns."""
    if not rows:
        raise ResultError(f"stored results have no rows of {what}")
    for column in columns:
        if column not in rows[0]:
            raise ResultError(f"stored rows of {what} have no column {column}; scripts/reference makes them anew")
    return rows
