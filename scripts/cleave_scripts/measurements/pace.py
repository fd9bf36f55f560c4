"""The pace of replays: one may be slower than another throughout, and cells that all of them have say by how much."""
import statistics

from cleave_scripts.results.rows import combination, total_ms


def place(row):
    return row["replay"], row["round"], row["step"]


def paces_of(rows, paces):
    """{place(row): how much slower than usual the cells were there of which paces(row) says that all replays have them;
    their median}"""
    cells, slower = {}, {}
    for row in filter(paces, rows):
        cells.setdefault((row["step"], row["solver"], combination(row)), {})[place(row)] = total_ms(row)
    for times in cells.values():
        usual = statistics.median(times.values())
        for where, time_ms in times.items():
            slower.setdefault(where, []).append(time_ms / usual)
    return {where: statistics.median(ratios) for where, ratios in slower.items()}
