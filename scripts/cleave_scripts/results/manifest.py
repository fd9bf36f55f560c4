"""manifest.json of an output directory."""
import json
import pathlib

from cleave_scripts.results.command_line import counted
from cleave_scripts.results.errors import ResultError


def load_manifest(directory):
    """manifest.json of an output directory; an empty dictionary where there is none."""
    path = pathlib.Path(directory) / "manifest.json"
    if not path.exists():
        return {}
    try:
        manifest = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise ResultError(f"{path}: {error}") from None
    if not isinstance(manifest, dict):
        raise ResultError(f"{path}: expected an object")
    return manifest


def processor(manifest):
    """What it ran on: times of two are not averaged."""
    return manifest.get("machine", {}).get("cpu_model", "unknown")


def machine(manifest):
    """One line about where a run was made: processor, cores, threads, commit."""
    if not manifest:
        return "unknown machine (no manifest.json)"
    build, place = manifest.get("build", {}), manifest.get("machine", {})
    changed = " with local changes" if build.get("git_dirty") == "true" else ""
    return (
        f"{place.get('cpu_model', 'unknown processor')}, {counted(place.get('cores', 'unknown'), 'core')}, "
        f"{counted(manifest.get('options', {}).get('threads', 'unknown'), 'thread')}, "
        f"commit {build.get('git_hash', 'unknown')[:10]}{changed}")
