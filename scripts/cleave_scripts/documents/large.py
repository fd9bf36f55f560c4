"""Running simulations, very large scenes, and the orders in which bodies are eliminated."""
from cleave_scripts.documents.stored import need
from cleave_scripts.measurements import elimination_orders as elimination
from cleave_scripts.measurements import large_scenes as scenes
from cleave_scripts.measurements import running_simulation as running
from cleave_scripts.results.rows import group
from cleave_scripts.table import text

RUNNING = ("running_simulation.csv", "scripts/running_simulation")
LARGE = ("large_scenes.csv", "scripts/large_scenes")
ORDERS = ("elimination_orders.csv", "scripts/elimination_orders")


def _rounds(rows):
    return len({row["round"] for row in rows})


def running_simulation(stored):
    rows = need(stored.table(*RUNNING), "running simulations", "session", "sweep_ms")
    return (f"`{running.SOLVER}`, one thread, warm from the step before, every step solved; medians of {_rounds(rows)} rounds, "
            f"then means over the steps (`{RUNNING[1]}`; {stored.origin(RUNNING[0])}). A sweep is one of `{running.SWEEPER}` "
            f"on the same steps in the same run:\n\n{running.markdown(rows)}")


def large_scenes(stored):
    rows = need(stored.table(*LARGE), "large scenes", "dissection_mflop", "dense_gflop_per_s")
    piles, silos, left_out = scenes.markdown(rows)
    return (f"A step by `exact`, from the impulses recorded with it, medians of {_rounds(rows)} replays (`{LARGE[1]}`; "
            f"{stored.origin(LARGE[0])}). {left_out} Rock piles; a sweep is one of `{running.SWEEPER}` on the same step in the "
            f"same round:\n\n{piles}\n\nSilos; the dense factorisation is that of {scenes.DENSE_ROWS} rows on as many threads, "
            f"in the same run:\n\n{silos}")


def elimination_orders(stored):
    rows = need(stored.table(*ORDERS), "orders of elimination", "factor_mflop")
    lines = []
    for (scene, bodies, step), of_step in group(rows, "scene", "bodies", "step").items():
        counts = {row["order"]: text.number(float(row["factor_mflop"])) for row in of_step}
        lines.append([f"{scene.replace('_', ' ')}, {bodies} bodies, step {step}", of_step[0]["rows"],
                      *(counts[order] for order in elimination.ORDERS)])
    return (f"Mflop of one factorisation, counted without padding (`{ORDERS[1]}`; {stored.origin(ORDERS[0])}); leaves of a "
            f"tree have at most so many bodies, `{elimination.CHOSEN}` is what that solver takes:\n\n" +
            text.table(["", "rows", *elimination.ORDERS], lines))


BLOCKS = {"running_simulation": running_simulation, "large_scenes": large_scenes, "elimination_orders": elimination_orders}
