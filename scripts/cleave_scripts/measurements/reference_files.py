"""Moves what the stages of scripts/reference made into results/, with a note of what made each file."""
import hashlib
import json

from cleave_scripts.measurements.reference_stages import RUN_FILES, STAGES
from cleave_scripts.results.campaign import run_files_below
from cleave_scripts.results.errors import ResultError
from cleave_scripts.results.whole_file import write_bytes, write_text

APART = "torture"  # what scripts/torture leaves, which says itself what made it


def _sources(stage, directory):
    """(file, where to below results/)"""
    for name, path in (entry for file in RUN_FILES for entry in run_files_below(directory, file)):
        for runs, target in stage.runs:
            if name.startswith(f"{runs}/"):
                yield path, f"{target}/{name.removeprefix(f'{runs}/')}/{path.name}"
    for pattern, target in stage.files:
        for path in sorted(directory.glob(pattern)):
            yield path, (target + path.name if target.endswith("/") else target)


def _copy(source, target, root):
    """Paths in JSON are written relative to the checkout."""
    if source.suffix == ".json":
        write_text(target, source.read_text(encoding="utf-8").replace(f"{root}/", ""))
    else:
        write_bytes(target, source.read_bytes())


def _write_checksums(results):
    """Of every stored run anew, for `cleave verify`: the paths in its manifest are others now."""
    for manifest in sorted(results.rglob("manifest.json")):
        files = [path for path in (manifest.parent / name for name in RUN_FILES) if path.is_file()]
        lines = [f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.name}\n" for path in files]
        write_text(manifest.parent / "checksums", "".join(lines))


def _check_complete(stage, directory):
    """A stage that is kept may have lost files since it was done."""
    there = {file: [name for name, _ in run_files_below(directory, file)] for file in RUN_FILES}
    missing = [f"{file} below {runs}" for file, names in there.items() for runs, _ in stage.runs
               if not any(name.startswith(f"{runs}/") for name in names)]
    missing += [pattern for pattern, _ in stage.files if not any(directory.glob(pattern))]
    if missing:
        raise ResultError(f"stage {stage.name}: {directory} has no {' and no '.join(missing)}; nothing is stored. Take its line out "
                          "of out/reference/stages.jsonl and give the command again")


def publish(root, records):
    """results/ holds then what the stages made, and of older results nothing."""
    out, results = root / "out" / "reference", root / "results"
    for stage in STAGES:
        _check_complete(stage, out / stage.place)
    found = {stage: list(_sources(stage, out / stage.place)) for stage in STAGES}
    for path in sorted(results.rglob("*"), reverse=True):
        if APART in path.relative_to(results).parts:
            continue
        if path.is_dir():
            if not any(path.iterdir()):
                path.rmdir()
        elif path.suffix != ".md":
            path.unlink()
    notes = {}
    for stage, files in found.items():
        for source, target in files:
            _copy(source, results / target, root)
        notes |= {target: records[stage.name] for source, target in files if source.name not in RUN_FILES}
        for _, target in stage.files:
            if target.endswith("/"):
                notes[target.rstrip("/")] = records[stage.name]
    _write_checksums(results)
    text = json.dumps({"schema": "cleave-provenance-1", "files": notes}, indent=2)
    write_text(results / "provenance.json", text + "\n")
