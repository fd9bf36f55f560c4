"""The runs of scripts/scaling, which scripts/report_runs makes too."""
from cleave_scripts.measurements.runs import Run
from cleave_scripts.results.paper import ASKED_REFINERS

SIZES = (50, 100, 200, 400, 600, 800)
PARTITIONERS = "mindp,mix"


def runs_of_sizes(out, sizes, partitioner, settings):
    for number, size in enumerate(sizes, 1):
        words = ("--scene", "rock_pile", "--bodies", str(size), "--partitioner", partitioner, "--refiner", ASKED_REFINERS,
                 "--solver", "schur")
        yield Run(out / "scaling" / f"bodies_{size}", f"[{number}/{len(sizes)}] {size} rocks", f"{size} rocks", words, settings)
