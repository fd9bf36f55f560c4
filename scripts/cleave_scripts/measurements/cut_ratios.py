"""What scripts/benchmark_partitioners measured: cuts and times against those of METIS and SCOTCH.

Of ten seeds the least cut counts in which no part is above the bound. Graphs on which nobody cuts anything are left out.
"""
import dataclasses
import statistics

PEERS = ("metis-recursive+none", "metis-kway+none", "scotch+none", "scotch@scotch-strategy=balance+none",
         "scotch@scotch-strategy=speed+none", "scotch@scotch-strategy=quality+none")
CLOCK = "metis-recursive+none"  # what times are told against
TIMED_BODIES = (200, 10000)
NEAR, FAR = "pile_1000", "pile_100000"  # graphs between which the growth of the time is told


@dataclasses.dataclass(frozen=True)
class Ratios:
    rows: float  # interface rows over the least of the peers, geometric mean over the graphs
    worst_rows: float
    worst_graph: str
    speed: float  # how many times as fast as CLOCK, geometric mean over graphs of TIMED_BODIES
    least_speed: float
    growth: float  # CPU time a body on FAR over that on NEAR


def by_graph(rows):
    """{graph: {partitioner+refiner: row}}"""
    found = {}
    for row in rows:
        graph, name = row["name"].split("/", 1)
        found.setdefault(graph, {})[name] = row
    return found


def cut_of(row):
    """None where every result had a part above the bound."""
    return row.get("interface_rows") if row else None


def _peers_best(cells):
    return min((cut for cut in (cut_of(cells.get(name)) for name in PEERS) if cut is not None), default=None)


def _row_ratios(graphs, name):
    return {graph: cut_of(cells[name]) / best for graph, cells in graphs.items()
            if (best := _peers_best(cells)) and name in cells and cut_of(cells[name]) is not None}


def _speeds(graphs, name):
    least, most = TIMED_BODIES
    return [cells[CLOCK]["cpu_time"] / cells[name]["cpu_time"] for cells in graphs.values()
            if name in cells and CLOCK in cells and least <= cells[CLOCK]["bodies"] <= most]


def _time_per_body(graphs, graph, name):
    row = graphs.get(graph, {}).get(name)
    return row["cpu_time"] / row["bodies"] if row else float("nan")


def ratios(graphs, name):
    """None where there is nothing to compare."""
    rows, speeds = _row_ratios(graphs, name), _speeds(graphs, name)
    if not rows or not speeds:
        return None
    worst = max(rows, key=rows.get)
    return Ratios(statistics.geometric_mean(rows.values()), rows[worst], worst, statistics.geometric_mean(speeds), min(speeds),
                  _time_per_body(graphs, FAR, name) / _time_per_body(graphs, NEAR, name))
