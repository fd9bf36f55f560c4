"""The table of scripts/benchmark_dense, from what the benchmark program wrote."""
import statistics

from cleave_scripts.table import text

SETS = ("AVX2", "AVX-512")


def gflops(benchmarks):
    """{row: median Gflop/s}"""
    found = {}
    for entry in benchmarks:
        found.setdefault(entry["name"].removesuffix("/manual_time"), []).append(entry["gflop_per_s"])
    return {name: statistics.median(values) for name, values in found.items()}


def _share(rate, of):
    return f"{rate:.1f} ({100 * rate / of:.0f} %)"


def _line(rates, rows):
    """Rates of one size: with each instruction set, against OpenBLAS, and on two threads against what there is."""
    shown = [_share(rates[f"cholesky:{name}/{rows}"], rates[f"peak:{name}"]) if f"peak:{name}" in rates else "-"
             for name in SETS]
    widest = next(name for name in reversed(SETS) if f"peak:{name}" in rates)
    ours, blas = rates[f"cholesky:{widest}/{rows}"], rates[f"openblas/{rows}"]
    ceiling = 2 * rates[f"side_by_side/{rows}"]
    return [rows, *shown, f"{blas:.1f}", f"{ours / blas:.2f}", f"{rates[f'cholesky_2/{rows}']:.1f}", f"{ceiling:.1f}",
            f"{rates[f'cholesky_2/{rows}'] / ceiling:.2f}"]


def markdown(benchmarks):
    rates = gflops(benchmarks)
    peaks = ", ".join(f"{name} {rates[f'peak:{name}']:.1f}" for name in SETS if f"peak:{name}" in rates)
    sizes = sorted(int(name.split("/")[1]) for name in rates if name.startswith("openblas/"))
    header = ["rows", *(f"{name} (of its peak)" for name in SETS), "OpenBLAS", "ours / OpenBLAS", "two threads",
              "two side by side", "two threads / side by side"]
    inside = [f"{rates[name]:.1f} Gflop/s ({name.split('/')[1]} interface rows, the widest instruction set, one thread)"
              for name in rates if name.startswith("inside/")]
    return (f"Gflop/s of one Cholesky factorisation, one thread where nothing else is said; multiply-add peak: {peaks}. "
            f"Inside the kernel `schur-rows`, on a step of Large Rock Pile split by `mindp`: {'; '.join(inside)}.\n\n" +
            text.table(header, [_line(rates, rows) for rows in sizes]))
