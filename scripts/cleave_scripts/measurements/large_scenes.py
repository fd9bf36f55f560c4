"""What scripts/large_scenes measured: one step of very large scenes by the exact solver, its factorisation beside a dense one of the
same minute and beside nested dissection."""
import statistics
import subprocess

from cleave_scripts.measurements import dense_ratios
from cleave_scripts.results.programs import benchmark_beside, load_benchmark, run
from cleave_scripts.table import text

DENSE_ROWS = 3000  # a front at the top of a silo's tree has as many, or more
DENSE_REPETITIONS = 3
COLUMNS = ("scene", "bodies", "step", "threads", "round", "rows", "factorizations", "kinetic_energy_j", "t_s_ms", "t_s_waiting_ms",
           "t_s_factor_local_ms", "factor_mflop_local", "factor_mflop_done", "dissection_mflop", "dense_gflop_per_s", "peak_memory_mb", "status")


def dense_rates(program, path):
    """{threads: Gflop/s} of the dense Cholesky factorisation, with the widest instruction set."""
    run([benchmark_beside(program, "dense_benchmark"), f"--benchmark_filter=^cholesky.*/{DENSE_ROWS}/",
         f"--benchmark_repetitions={DENSE_REPETITIONS}", "--benchmark_min_time=0.02", f"--benchmark_out={path}",
         "--benchmark_out_format=json"], stdout=subprocess.DEVNULL)
    rates = dense_ratios.gflops(load_benchmark(path))
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


def _median(rows, value):
    return statistics.median(map(value, rows))


def _us_by_round(rows):
    return {row["round"]: _us_per_row(row) for row in rows}


def _cells(rows, scene):
    """{(bodies, threads): rows of all rounds}, the smallest scene first."""
    found = {}
    for row in rows:
        if row["scene"] == scene:
            found.setdefault((int(row["bodies"]), int(row["threads"])), []).append(row)
    return dict(sorted(found.items()))


def pile_lines(rows):
    """A line a rock pile; "against the smallest" is the median over the rounds of their quotients."""
    cells = _cells(rows, "rock_pile")
    smallest_us = _us_by_round(next(iter(cells.values())))
    for (bodies, _), of_cell in cells.items():
        first = of_cell[0]
        ratio = statistics.median(us / smallest_us[number] for number, us in _us_by_round(of_cell).items())
        yield [bodies, first["rows"], first["factorizations"], text.number(float(first["kinetic_energy_j"]) / bodies),
               text.number(_median(of_cell, _t_s_ms)), text.number(_median(of_cell, _us_per_row)), f"{ratio:.2f}",
               f"{max(float(row['peak_memory_mb']) for row in of_cell) / 1e3:.2f}"]


def silo_lines(rows):
    """A line a silo and number of threads."""
    for (bodies, threads), of_cell in _cells(rows, "silo").items():
        first = of_cell[0]
        mflop, dissected = float(first["factor_mflop_local"]), float(first["dissection_mflop"])
        yield [bodies, threads, first["rows"], first["factorizations"], text.number(_median(of_cell, _t_s_ms)), text.number(mflop / 1e3),
               f"{mflop / dissected:.2f}", text.number(_median(of_cell, _gflop_per_s)), text.number(_median(of_cell, _dense_gflop_per_s)),
               text.percent(_median(of_cell, _dense_share))]


PILE_HEADER = ("rocks", "rows", "factorisations", "kinetic energy, J a rock", "t_s, ms", "µs a row and factorisation", "against the smallest",
               "peak memory, GB")
SILO_HEADER = ("boxes", "threads", "rows", "factorisations", "t_s, ms", "Gflop of one", "over METIS's", "Gflop/s", "dense, Gflop/s", "share")


def markdown(rows):
    """Two tables, piles and silos."""
    return text.table(PILE_HEADER, pile_lines(rows)), text.table(SILO_HEADER, silo_lines(rows))
