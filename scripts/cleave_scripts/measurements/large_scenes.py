"""What scripts/large_scenes measured: one step of very large scenes by the exact solver, its factorisation beside a dense one
of the same minute and beside nested dissection, and of rock piles sweeps of projected Gauss-Seidel over the same rows.

Rows whose solves waited for a core do not count where times are compared; a cell without another is told as not measured.
"""
import math
import statistics
import subprocess

from cleave_scripts.measurements import dense_ratios
from cleave_scripts.measurements.modelled_times import has_waited, waited_in_words
from cleave_scripts.measurements.running_simulation import SOLVER, SWEEPER, SWEEPS
from cleave_scripts.results.programs import benchmark_beside, load_benchmark, run
from cleave_scripts.table import text

DENSE_ROWS = 3000  # a front at the top of a silo's tree has as many, or more
DENSE_REPETITIONS = 3
LEAST_DENSE_SHARE = 0.75  # asked of the factorisation of a silo
MOST_RATIO = 1.6  # asked of a row and factorisation of a larger pile, against the smallest
MOST_SWEEPS = {10000: 90}  # rocks: asked of t_s on one thread
COLUMNS = ("scene", "bodies", "step", "solver", "threads", "round", "rows", "factorizations", "kinetic_energy_j", "t_s_ms",
           "t_s_waiting_ms", "t_s_factor_local_ms", "factor_mflop_local", "factor_mflop_done", "dissection_mflop",
           "dense_gflop_per_s", "peak_memory_mb", "status")


def dense_rates(program, path):
    """{threads: Gflop/s} of the dense Cholesky factorisation, with the widest instruction set."""
    run([benchmark_beside(program, "dense_benchmark"), f"--benchmark_filter=^cholesky.*/{DENSE_ROWS}/",
         f"--benchmark_repetitions={DENSE_REPETITIONS}", "--benchmark_min_time=0.02", f"--benchmark_out={path}",
         "--benchmark_out_format=json"], stdout=subprocess.DEVNULL)
    rates = dense_ratios.gflops(load_benchmark(path, program))
    widest = [name for name in dense_ratios.SETS if f"cholesky:{name}/{DENSE_ROWS}" in rates][-1]
    return {1: rates[f"cholesky:{widest}/{DENSE_ROWS}"], 2: rates[f"cholesky_2/{DENSE_ROWS}"]}


def _us_per_row(row):
    """A row and factorisation."""
    return 1e3 * float(row["t_s_ms"]) / (int(row["rows"]) * int(row["factorizations"]))


def _gflop_per_s(row):
    return float(row["factor_mflop_done"]) / float(row["t_s_factor_local_ms"])


def _dense_gflop_per_s(row):
    return float(row["dense_gflop_per_s"])


def _dense_share(row):
    return _gflop_per_s(row) / _dense_gflop_per_s(row)


def _t_s_ms(row):
    return float(row["t_s_ms"])


def _sweep_ms(row):
    return _t_s_ms(row) / SWEEPS


def _median(values):
    values = list(values)
    return statistics.median(values) if values else math.nan


def _timed(rows):
    return [row for row in rows if not has_waited(row)]


def _by_round(rows, value):
    return {row["round"]: value(row) for row in _timed(rows)}


def _ratio(values, others):
    """Median over the rounds that both have of their quotients."""
    return _median(value / others[number] for number, value in values.items() if number in others)


def _cells(rows, scene, solver=SOLVER):
    """{(bodies, threads): rows of all rounds}, the smallest scene first. Rows without the column are of the exact solver."""
    found = {}
    for row in rows:
        if (row["scene"], row.get("solver", SOLVER)) == (scene, solver):
            found.setdefault((int(row["bodies"]), int(row["threads"])), []).append(row)
    return dict(sorted(found.items()))


def _verdict(value, is_so):
    return "not measured" if math.isnan(value) else text.holds(is_so)


def pile_lines(rows):
    """A line a rock pile and number of threads."""
    cells, sweeps = _cells(rows, "rock_pile"), _cells(rows, "rock_pile", SWEEPER)
    smallest = {}  # by threads
    for (bodies, threads), of_cell in cells.items():
        first, us = of_cell[0], _by_round(of_cell, _us_per_row)
        ratio = _ratio(us, smallest.setdefault(threads, us))
        in_sweeps = _ratio(_by_round(of_cell, _t_s_ms), _by_round(sweeps.get((bodies, threads), ()), _sweep_ms))
        asked = []
        if us is not smallest[threads]:
            asked.append(f"at most {MOST_RATIO} times the smallest: {_verdict(ratio, ratio <= MOST_RATIO)}")
        if bodies in MOST_SWEEPS and threads == 1:
            asked.append(f"at most {MOST_SWEEPS[bodies]} sweeps: {_verdict(in_sweeps, in_sweeps <= MOST_SWEEPS[bodies])}")
        yield [bodies, threads, first["rows"], first["factorizations"], text.number(float(first["kinetic_energy_j"]) / bodies),
               text.number(_median(map(_t_s_ms, _timed(of_cell)))), text.number(_median(us.values())), text.two_decimals(ratio),
               text.number(in_sweeps), f"{max(float(row['peak_memory_mb']) for row in of_cell) / 1e3:.2f}",
               "; ".join(asked) or "-"]


def silo_lines(rows):
    """A line a silo and number of threads."""
    for (bodies, threads), of_cell in _cells(rows, "silo").items():
        first, timed = of_cell[0], _timed(of_cell)
        mflop, dissected = float(first["factor_mflop_local"]), float(first["dissection_mflop"])
        share = _median(map(_dense_share, timed))
        yield [bodies, threads, first["rows"], first["factorizations"], text.number(_median(map(_t_s_ms, timed))),
               text.number(mflop / 1e3), f"{mflop / dissected:.2f}", text.number(_median(map(_gflop_per_s, timed))),
               text.number(_median(map(_dense_gflop_per_s, timed))),
               text.percent(share), _verdict(share, share >= LEAST_DENSE_SHARE)]


PILE_HEADER = ("rocks", "threads", "rows", "factorisations", "kinetic energy, J a rock", "t_s, ms",
               "µs a row and factorisation", "against the smallest", "t_s in sweeps", "peak memory, GB", "asked")
SILO_HEADER = ("boxes", "threads", "rows", "factorisations", "t_s, ms", "Gflop of one", "over METIS's", "Gflop/s",
               "dense, Gflop/s", "share", f"asked {text.percent(LEAST_DENSE_SHARE)} or more")


def markdown(rows):
    """Two tables, piles and silos, and what was left out."""
    return (text.table(PILE_HEADER, pile_lines(rows)), text.table(SILO_HEADER, silo_lines(rows)),
            waited_in_words(sum(map(has_waited, rows))))
