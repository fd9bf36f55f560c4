"""What scripts/elimination_orders counted: the arithmetic of one factorisation of recorded steps, in every order of elimination
that was thought of."""
import pathlib

from cleave_scripts.measurements.dissection import dissection_mflop
from cleave_scripts.measurements.every_scene import EVERY_SCENE
from cleave_scripts.results.programs import record, replay

SWEPT = ("--advance", "pgs@sweeps=30")  # what moves the largest, where nothing is asked but a contact graph
# (scene, step, options)
STEPS = (*((scene, 200, options) for scene, options in EVERY_SCENE.items()),
         ("rock_pile", 200, ("--bodies", "600")), ("rock_pile", 100, ("--bodies", "10000", *SWEPT)),
         ("silo", 20, ("--bodies", "1000")), ("silo", 2, ("--bodies", "2000", *SWEPT)),
         ("silo", 2, ("--bodies", "10000", *SWEPT)))
MINIMUM_DEGREE, CHOSEN, METIS = "minimum degree", "exact", "nested dissection, METIS"
LEAVES = (25, 50, 100, 200)  # most bodies of a leaf of the tree of schur-nested
COLUMNS = ("scene", "bodies", "step", "rows", "order", "factor_mflop")
WHOLE, NESTED = "exact", "pivot:schur-nested"
ONE_PART = "single"


def tree(size):
    return f"multilevel@effort=best@max-bodies={size}"


def _order_of(row):
    """What eliminated in a replayed row."""
    if row["solver"] == WHOLE:
        return CHOSEN
    names = {ONE_PART: MINIMUM_DEGREE} | {tree(size): f"tree of schur-nested, {size}" for size in LEAVES}
    return names[row["partitioner"]]


ORDERS = (MINIMUM_DEGREE, METIS, *(f"tree of schur-nested, {size}" for size in LEAVES), CHOSEN)


def _counted(row):
    """What is not there is -1."""
    return sum(max(0.0, float(row[f"factor_mflop_{where}"])) for where in ("local", "interface"))


def count(program, scratch, scene, step, options):
    """Rows of COLUMNS of one step."""
    file, = record(program, pathlib.Path(scratch) / "step", scene, [step], *options, all_ok=False)
    partitioners = ",".join((ONE_PART, *map(tree, LEAVES)))
    rows = replay(program, pathlib.Path(scratch) / "replay", [file], "--solver", f"{WHOLE},{NESTED}", "--partitioner",
                  partitioners, "--refiner", "none", "--repeats", 1, all_ok=True)
    counts = {_order_of(row): _counted(row) for row in rows} | {METIS: dissection_mflop(file)}
    about = {name: rows[0][name] for name in ("scene", "bodies", "step", "rows")}
    return [{**about, "order": order, "factor_mflop": f"{counts[order]:.6g}"} for order in ORDERS]
