"""What scripts/benchmark_partitioners measured: cuts and times against those of METIS and SCOTCH.

Of ten seeds the least cut counts in which no part is above the bound. Graphs on which nobody cuts anything are left out.
"""
import dataclasses
import statistics

PEERS = ("metis-recursive+none", "metis-kway+none", "scotch+none", "scotch@scotch-strategy=balance+none",
         "scotch@scotch-strategy=speed+none", "scotch@scotch-strategy=quality+none")
CLOCK = "metis-recursive+none"  # what times are told against
TIMED_BODIES = (200, 10000)
BEST, FAST = "multilevel@effort=best+none", "multilevel@effort=fast+none"
MENDED = ("mindp@merge-small=true+fm", "mix@merge-small=true+fm")
# What was asked of them.
WORST, WORST_ROWS, FAST_SPEED, FAST_ROWS, MOST_GROWTH, MENDED_ROWS = 1.1, 12, 5, 1.05, 3, 1.15
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


def _clock_ratios(graphs, name):
    """{graph: interface rows over those of CLOCK}, graphs of TIMED_BODIES."""
    least, most = TIMED_BODIES
    return {graph: cut_of(cells[name]) / cut_of(cells[CLOCK]) for graph, cells in graphs.items()
            if name in cells and least <= cells[name]["bodies"] <= most and cut_of(cells[name]) is not None and
            cut_of(cells.get(CLOCK))}


def _is_near_peers(cells, name):
    """At most WORST times the rows of the best peer, or WORST_ROWS more."""
    best, cut = _peers_best(cells), cut_of(cells.get(name))
    return not best or cut is not None and (cut <= WORST * best or cut <= best + WORST_ROWS)


def _mean_and_worst(ratios_by_graph):
    worst = max(ratios_by_graph, key=ratios_by_graph.get)
    return (f"{statistics.geometric_mean(ratios_by_graph.values()):.3f}, most {ratios_by_graph[worst]:.3f} on "
            f"{worst.replace('_', ' ')}")


def _targets_of_best(graphs):
    found = ratios(graphs, BEST)
    far = [graph.replace("_", " ") for graph, cells in graphs.items() if not _is_near_peers(cells, BEST)]
    return [(f"`effort=best` cuts at most what the best peer cuts, in the mean: {found.rows:.3f}", found.rows <= 1),
            (f"on no graph more than {round(100 * WORST - 100)} % or {WORST_ROWS} rows more: {', '.join(far) or 'none'}",
             not far),
            (f"and is no slower than METIS recursive: {found.least_speed:.2f} times as fast at least", found.least_speed >= 1)]


def _targets_of_fast(graphs):
    found, rows = ratios(graphs, FAST), _clock_ratios(graphs, FAST)
    within = sum(ratio <= FAST_ROWS for ratio in rows.values())
    return [(f"`effort=fast` is at least {FAST_SPEED} times as fast as METIS recursive on graphs of {TIMED_BODIES[0]} to "
             f"{TIMED_BODIES[1]} bodies: {found.least_speed:.2f}", found.least_speed >= FAST_SPEED),
            (f"with at most {FAST_ROWS} times its rows in the mean: {_mean_and_worst(rows)}",
             statistics.geometric_mean(rows.values()) <= FAST_ROWS),
            (f"and on every one of these graphs: {within} of {len(rows)}", within == len(rows)),
            (f"a body takes at most {MOST_GROWTH} times as long at 100000 as at 1000: {found.growth:.2f}",
             found.growth <= MOST_GROWTH)]


def _targets_of_mended(graphs, name):
    rows = _row_ratios(graphs, name)
    within = sum(ratio <= MENDED_ROWS for ratio in rows.values())
    title = name.split("@", maxsplit=1)[0] + "+fm, mended"
    return [(f"{title}, is within {round(100 * MENDED_ROWS - 100)} % of the best peer in the mean: {_mean_and_worst(rows)}",
             statistics.geometric_mean(rows.values()) <= MENDED_ROWS),
            (f"{title}, on every graph too: {within} of {len(rows)}", within == len(rows))]


def targets(graphs):
    """[(what was asked and what was found, whether that holds)]"""
    return [*_targets_of_best(graphs), *_targets_of_fast(graphs),
            *(target for name in MENDED for target in _targets_of_mended(graphs, name))]


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
