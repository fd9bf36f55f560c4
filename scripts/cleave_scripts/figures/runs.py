"""What was run: a table a machine, in which runs that differ in nothing but name and scene share a line."""
import re

from cleave_scripts.figures import page
from cleave_scripts.figures.choose import step_count
from cleave_scripts.figures.table_html import rich
from cleave_scripts.results.manifest import machine
from cleave_scripts.results.names import in_order, title
from cleave_scripts.results.paper import SCENES

HEAD = ("directories", "scenes", "solvers", "steps measured", "rows ok", "state")


def runs_body(experiments):
    """HTML; experiments in the order of the tree."""
    places = {}
    for experiment in experiments:
        places.setdefault(machine(experiment.manifest), []).append(experiment)
    return "".join(
        f'<p class="caption">On {rich(name)}, {_started(found)}:</p>{page.table(HEAD, _lines(found))}'
        for name, found in places.items())


def _started(experiments):
    times = sorted({str(experiment.manifest.get("utc_start", "?")) for experiment in experiments})
    return f"started {times[0]}" + (f" to {times[-1]}" if len(times) > 1 else "")


def _lines(experiments):
    groups = {}
    for experiment in experiments:
        groups.setdefault(_alike(experiment), []).append(experiment)
    for (folder, solvers, steps, state), found in groups.items():
        names = ", ".join(sorted((experiment.name.rpartition("/")[2] for experiment in found), key=_natural))
        scenes = in_order((scene for experiment in found for scene in experiment.rows["scene"]), SCENES)
        status = [value for experiment in found for value in experiment.rows["status"]]
        yield (f"{folder}/ {names}" if folder else names, ", ".join(map(title, scenes)), solvers, steps,
               f"{status.count('ok')} of {len(status)}", state)


def _natural(name):
    """Sorts pgs_30 before pgs_100."""
    return [int(part) if part.isdigit() else part for part in re.split(r"(\d+)", name)]


def _alike(experiment):
    """(folder, solvers, steps, state): what the runs of one line share."""
    steps = f"{step_count(experiment.rows)} of {experiment.manifest.get('options', {}).get('steps', '?')}"
    return (experiment.name.rpartition("/")[0], ", ".join(sorted(experiment.rows["solver"].unique())), steps,
            str(experiment.manifest.get("state", "?")))
