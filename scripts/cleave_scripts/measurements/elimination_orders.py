"""What scripts/elimination_orders counted: the arithmetic of one factorisation of recorded steps, in every order of elimination
that was thought of."""
import pathlib

from cleave_scripts.measurements.dissection import dissection_mflop
from cleave_scripts.measurements.every_scene import EVERY_SCENE, MOVED_FAST
from cleave_scripts.results.programs import record, replay

# (scene, step, options)
STEPS = (*((scene, 200, options) for scene, options in EVERY_SCENE.items()),
         ("rock_pile", 200, ("--bodies", "600")), ("rock_pile", 100, ("--bodies", "10000", *MOVED_FAST)),
         ("silo", 20, ("--bodies", "1000")), ("silo", 2, ("--bodies", "2000", *MOVED_FAST)),
         ("silo", 2, ("--bodies", "10000", *MOVED_FAST)))
WHOLE, NESTED = "exact", "pivot:schur-nested"
MINIMUM_DEGREE, METIS, CHOSEN = "minimum degree", "nested dissection, METIS", WHOLE
TREES = {f"multilevel@effort=best@max-bodies={size}": f"tree of schur-nested, {size}" for size in (25, 50, 100, 200)}
SPLITS = {"single": MINIMUM_DEGREE} | TREES  # partitioner of NESTED: the order that it leads to
ORDERS = (MINIMUM_DEGREE, METIS, *TREES.values(), CHOSEN)
COLUMNS = ("scene", "bodies", "step", "rows", "order", "factor_mflop")


def _order_of(row):
    return CHOSEN if row["solver"] == WHOLE else SPLITS[row["partitioner"]]


def _counted(row):
    """What is not there is -1."""
    return sum(max(0.0, float(row[f"factor_mflop_{where}"])) for where in ("local", "interface"))


def count(program, scratch, scene, step, options):
    """Rows of COLUMNS of one step."""
    file, = record(program, pathlib.Path(scratch) / "step", scene, [step], *options, all_ok=False)
    rows = replay(program, pathlib.Path(scratch) / "replay", [file], "--solver", f"{WHOLE},{NESTED}", "--partitioner",
                  ",".join(SPLITS), "--refiner", "none", "--repeats", 1, all_ok=True)
    counts = {_order_of(row): _counted(row) for row in rows} | {METIS: dissection_mflop(file)}
    about = {name: rows[0][name] for name in ("scene", "bodies", "step", "rows")}
    return [{**about, "order": order, "factor_mflop": f"{counts[order]:.6g}"} for order in ORDERS]
