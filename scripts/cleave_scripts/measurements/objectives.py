"""What scripts/partition_objectives measured: parts that are to take little time, as the cost model of the kernel tells it,
against parts of the same method that are to cut few rows.

A figure of a scene and kernel is a sum over its steps: of interface rows, and of the medians over rounds of t_s_ms and of
t_pr_ms + t_s_ms.
"""
import dataclasses
import statistics

from cleave_scripts.results.rows import combination, group, total_ms

STRATEGY = "pivot"
KERNELS = ("schur-rows", "schur-bodies", "schur-nested")
SIZES = (25, 100)  # most bodies of a part
# Partitioners and refiners of one replay.
REPLAYS = ((("mindp", "mix"), ("fm", "fm-cost")), (("multilevel", "multilevel-cost"), ("none",)))
COLUMNS = ("scene", "bodies", "step", "solver", "partitioner", "refiner", "max_bodies", "parts", "interface_rows", "threads",
           "round", "status", "t_pr_ms", "t_s_ms")


def sized(partitioner, size):
    return f"{partitioner}@max-bodies={size}"


# Of each size: the combination whose objective is the cut, and the same by modelled time.
PAIRS = {f"{sized(partitioner, size)}+{refiner}": f"{sized(other, size)}+{other_refiner}"
         for partitioner, refiner, other, other_refiner in (
             ("mindp", "fm", "mindp", "fm-cost"), ("mix", "fm", "mix", "fm-cost"),
             ("multilevel", "none", "multilevel-cost", "none"))
         for size in SIZES}


@dataclasses.dataclass(frozen=True)
class Gain:
    """By modelled time over by the cut."""
    rows: float
    t_s: float
    total: float  # t_pr + t_s


def _sums(rows):
    steps = group(rows, "step").values()
    return (sum(int(of_step[0]["interface_rows"]) for of_step in steps),
            sum(statistics.median(float(row["t_s_ms"]) for row in of_step) for of_step in steps),
            sum(statistics.median(map(total_ms, of_step)) for of_step in steps))


def _gain(cost, cut):
    return Gain(*(one / other if other else 1 if one == 0 else float("inf") for one, other in zip(_sums(cost), _sums(cut))))


def gains(rows):
    """{(scene, solver): {combination whose objective is the cut: Gain}}"""
    found = {}
    for key, of_kernel in group(rows, "scene", "solver").items():
        cells = {}
        for row in of_kernel:
            cells.setdefault(combination(row), []).append(row)
        found[key] = {cut: _gain(cells[cost], cells[cut]) for cut, cost in PAIRS.items()}
    return found
