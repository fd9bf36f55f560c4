"""Moves what the stages of scripts/reference made into results/, with a note of what made each file."""
import hashlib
import json

from cleave_scripts.measurements.reference_stages import RUN_FILES, STAGES
from cleave_scripts.results.campaign import INDEX, campaign_cells, is_campaign, run_files_below
from cleave_scripts.results.errors import ResultError
from cleave_scripts.results.whole_file import write_bytes, write_text

APART = "torture"  # what scripts/torture leaves, which says itself what made it
MOST_TOLD = 3  # of what is missing


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


def _write_checksums(run):
    """Of a stored run anew, for `cleave verify`: the paths in its manifest are others now. The path."""
    files = [path for path in (run / name for name in RUN_FILES) if path.is_file()]
    lines = [f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.name}\n" for path in files]
    write_text(run / "checksums", "".join(lines))
    return run / "checksums"


def _missing_runs(runs, directory):
    """What is not there of a campaign's cells: both files of each whose process came to its end."""
    campaign = runs.partition("/")[0]
    if not is_campaign(directory / campaign):
        return [f"{campaign}/{INDEX}"]
    cells = {f"{campaign}/{cell.name}": cell for cell in campaign_cells(directory / campaign) if cell.ran}
    mine = {name: cell for name, cell in cells.items() if name.startswith(f"{runs}/")}
    return [f"{file} of {name}" for name, cell in mine.items() for file in RUN_FILES
            if not (cell.directory / file).is_file()] if mine else [f"cell of {runs}"]


def _check_complete(stage, directory):
    """A stage that is kept may have lost files since it was done."""
    missing = [what for runs, _ in stage.runs for what in _missing_runs(runs, directory)]
    missing += [pattern for pattern, _ in stage.files if not any(directory.glob(pattern))]
    if missing:
        more = f" and lacks {len(missing) - MOST_TOLD} files more" if len(missing) > MOST_TOLD else ""
        raise ResultError(f"stage {stage.name}: {directory} has no {' and no '.join(missing[:MOST_TOLD])}{more}; nothing is "
                          "stored. Take its line out of out/reference/stages.jsonl and give the command again")


def _remove_others(results, written):
    """Of older results all but documents and what stands apart."""
    for path in sorted(results.rglob("*"), reverse=True):
        if APART in path.relative_to(results).parts:
            continue
        if path.is_dir():
            if not any(path.iterdir()):
                path.rmdir()
        elif path.suffix != ".md" and path not in written:
            path.unlink()


def publish(root, records):
    """results/ holds then what the stages made, and of older results nothing. What is there goes when all else is written."""
    out, results = root / "out" / "reference", root / "results"
    for stage in STAGES:
        _check_complete(stage, out / stage.place)
    found = {stage: list(_sources(stage, out / stage.place)) for stage in STAGES}
    notes, written = {}, {results / "provenance.json"}
    for stage, files in found.items():
        for source, target in files:
            _copy(source, results / target, root)
            written.add(results / target)
        notes |= {target: records[stage.name] for source, target in files if source.name not in RUN_FILES}
        for _, target in stage.files:
            if target.endswith("/"):
                notes[target.rstrip("/")] = records[stage.name]
    written |= {_write_checksums(run) for run in {path.parent for path in written if path.name in RUN_FILES}}
    text = json.dumps({"schema": "cleave-provenance-1", "files": notes}, indent=2)
    write_text(results / "provenance.json", text + "\n")
    _remove_others(results, written)
