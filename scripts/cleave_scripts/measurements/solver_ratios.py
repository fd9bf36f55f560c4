"""The ratios of scripts/benchmark_solvers, from what the benchmark program wrote."""
import statistics

from cleave_scripts.table import text

# (bodies, cfm): sweeps of projected Gauss-Seidel that an exact solve is held against.
SWEEPS = {(200, "1e-5"): 100, (200, "1e-8"): 300, (600, "1e-5"): 300, (800, "1e-5"): 300, (800, "1e-8"): 700}
PILES = tuple(SWEEPS)
HEADER = ("pile", "rows", "exact ms", "factorisations", "residual m/s", "PGS ns per row and sweep", "exact / PGS sweeps",
          "exact in CHOLMOD factorisations", "factor Gflop/s", "CHOLMOD / own factor", "assemble / factor",
          "schur-bodies 1 / 2 threads")


def name_of(bodies, cfm):
    return f"rocks_{bodies}_cfm_{cfm}"


def medians(benchmarks):
    """{(row, pile): (median ms, counters of one repetition)}"""
    times, counters = {}, {}
    for entry in benchmarks:
        row, pile = entry["name"].split("/")[:2]
        times.setdefault((row, pile), []).append(entry["real_time"])
        counters[row, pile] = entry
    return {key: (statistics.median(values), counters[key]) for key, values in times.items()}


def _line(rows, bodies, cfm):
    pile, sweeps = name_of(bodies, cfm), SWEEPS[bodies, cfm]

    def ms(row):
        return rows[row, pile][0]

    exact, counters = rows["exact", pile]
    cholmod = min(ms("cholmod:supernodal"), ms("cholmod:simplicial"))
    mflop = rows["cholmod:supernodal", pile][1]["mflop"]
    return (f"{bodies} rocks, cfm {cfm}", f"{counters['rows']:.0f}", f"{exact:.2f}", f"{counters['factorizations']:.0f}",
            f"{counters['residual_m_per_s']:.1e}", f"{ms('pgs:700') * 1e6 / (700 * counters['rows']):.1f}",
            f"{exact / ms(f'pgs:{sweeps}'):.2f} ({sweeps})", f"{exact / cholmod:.1f}", f"{mflop / ms('factor'):.1f}",
            f"{cholmod / ms('factor'):.1f}", f"{ms('assemble') / ms('factor'):.2f}",
            f"{ms('schur_bodies:1') / ms('schur_bodies:2'):.2f}")


def markdown(benchmarks):
    rows = medians(benchmarks)
    return text.table(HEADER, [_line(rows, *pile) for pile in PILES])
