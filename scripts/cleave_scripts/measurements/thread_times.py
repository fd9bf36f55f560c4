"""Medians of what scripts/two_threads and scripts/busy_machine measured."""
import statistics


def _medians(rows, *columns):
    """{values of the columns: median t_s in ms}"""
    times = {}
    for row in rows:
        times.setdefault(tuple(str(row[column]) for column in columns), []).append(float(row["t_s_ms"]))
    return {key: statistics.median(values) for key, values in times.items()}


def speed_ups(rows):
    """{(combination, step): t_s of one thread over that of two}"""
    times = _medians(rows, "partitioner", "refiner", "step", "threads")
    return {(f"{partitioner}+{refiner}", int(step)): time / times[partitioner, refiner, step, "2"]
            for (partitioner, refiner, step, threads), time in times.items() if threads == "1"}


def by_load(rows):
    """{busy loops: t_s in ms}, fewest loops first"""
    return {int(loops): time for (loops,), time in sorted(_medians(rows, "busy_loops").items())}
