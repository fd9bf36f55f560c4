"""Threads, solvers against each other, and cold starts."""
import dataclasses
import math
import statistics

from cleave_scripts.documents.stored import need
from cleave_scripts.measurements import builds, dense_ratios, model_ratios, modelled_times, solver_ratios, thread_times
from cleave_scripts.measurements.accuracy import threads_in_words
from cleave_scripts.results.names import title
from cleave_scripts.results.paper import BEST, SCENES
from cleave_scripts.table import text

THREADS = ("two_threads.csv", "scripts/two_threads")
MODELLED = ("modelled_workers.csv", "scripts/modelled_workers")
COLD = ("cold_starts.csv", "scripts/cold_starts")
BEFORE = ("compare_builds.csv", "scripts/compare_builds")
BENCHMARK = ("solver_benchmark.json", "scripts/benchmark_solvers")
DENSE = ("dense_benchmark.json", "scripts/benchmark_dense")
BUSY, IDLE = ("busy_machine.csv", "scripts/busy_machine"), ("idle_cost.csv", "scripts/idle_cost")
MOST_TIMES_AS_LONG = {1: 1.8, 2: 4}  # asked, by busy loops
SOLVERS = ("report/solvers/rocks_200", "scripts/report_runs --measure-every 25")
ONE_THREAD = ("report/one_thread", "scripts/report_runs --measure-every 25")
TWO_THREADS = ("full", "scripts/reproduce --measure-every 10")
COLD_ROWS = 1000


def _share(share):
    """A cell: the share, and what it is the quotient of."""
    return f"{f'{share.share:.2f}' if share.measured else '-'} ({text.two_decimals(share.ratio)} of {share.ceiling:.2f})"


def two_threads(stored):
    rows = need(stored.table(*THREADS), "two threads", "processes")
    found = thread_times.shares(rows)
    piles, (direct, sweeps) = thread_times.of_scene(found, "rock_pile"), thread_times.large_rock_pile(found)
    solvers = list(dict.fromkeys(share.solver for share in piles))
    cells = {(share.bodies, share.cfm, share.solver): _share(share) for share in piles}
    lines = [[bodies, f"{cfm:g}", *(cells[bodies, cfm, solver] for solver in solvers)]
             for bodies, cfm in dict.fromkeys((share.bodies, share.cfm) for share in piles)]
    far = thread_times.far_in_words(found)
    large = []
    for step, of_step in thread_times.by_step(direct).items():
        least = thread_times.least(of_step)
        large.append([step, f"`{least.combination}` {_share(least)}", *dataclasses.astuple(thread_times.counts(of_step))])
    return ("Two threads as a share of the ceiling: of what two independent solves on one thread each reach side by side in "
            "the same run, 2 on an ideal machine. In brackets t_s of one thread over that of two, and the ceiling; where that "
            f"is below {thread_times.LEAST_CEILING} no share is measured (-). Medians of {len({row['round'] for row in rows})} "
            f"rounds (`{THREADS[1]}`; {stored.origin(THREADS[0])}){f'; {far}' if far else ''}. Rock piles:\n\n" +
            text.table(["rocks", "cfm", *(f"`{solver}`" for solver in solvers)], lines) +
            "\n\n`schur` on Large Rock Pile, the least over the combinations, and how many are below what was asked:\n\n" +
            text.table(["step", "least share", *thread_times.COUNTED], large) + _sweeps(sweeps))


def _sweeps(found):
    """Of solvers that iterate on Large Rock Pile; nothing where none was measured."""
    if not found:
        return ""
    by_solver = {solver: [share for share in found if share.solver == solver]
                 for solver in dict.fromkeys(share.solver for share in found)}
    lines = [[f"`{solver}`", *map(_share, of_solver), thread_times.verdict(of_solver)]
             for solver, of_solver in by_solver.items()]
    return ("\n\nSolvers that iterate, on the same steps:\n\n" +
            text.table(["", *(f"step {step}" for step in thread_times.by_step(found)), "asked of every step"], lines))


def model(stored):
    """The modelled two-thread time against the measured one."""
    one, two = (model_ratios.solved_rows(stored.rows(*data), threads, data[0])
                for data, threads in ((ONE_THREAD, 1), (TWO_THREADS, 2)))
    found = model_ratios.compare(one, two)
    ratios = model_ratios.ratios(need(found.pairs, "the model"), ("scene",))
    lines = [[title(scene), len(ratios[scene,]),
              *map(text.number, model_ratios.quartiles(ratios[scene,]))] for scene in SCENES if (scene,) in ratios]
    return (f"Modelled over measured t_s on two threads, rows of `{ONE_THREAD[0]}` against those of `{TWO_THREADS[0]}` "
            f"({stored.origin(ONE_THREAD[0])}); {found.waited} pairs that waited for a core are "
            "left out:\n\n" +
            text.table(["scene", "pairs", "lower quartile", "median", "upper quartile"], lines))


def modelled_workers(stored):
    """The same of recorded steps, step by step."""
    rows = need(stored.table(*MODELLED), "modelled workers")
    rounds = len({row["round"] for row in rows})
    steps, waited = modelled_times.compare(rows)
    parts = [modelled_times.lines_of_costs(rows), modelled_times.lines_of_steps(steps, waited),
             modelled_times.lines_of_speed_ups(steps)]
    return (f"`{MODELLED[1]}`: replays of recorded steps with one and with two threads, in turn, the fastest of "
            f"{rounds} rounds, seed {text.listed(sorted({row['seed'] for row in rows}))}, `{'+'.join(BEST)}` "
            f"({stored.origin(MODELLED[0])}). "
            + "\n\n".join(filter(None, parts)))


def solver_benchmark(stored):
    return (f"{stored.origin(BENCHMARK[0])}:\n\n" + solver_ratios.markdown(stored.benchmark(*BENCHMARK)))


def dense(stored):
    return f"{stored.origin(DENSE[0])}:\n\n" + dense_ratios.markdown(stored.benchmark(*DENSE))


def busy_machine(stored):
    times = thread_times.by_load(need(stored.table(*BUSY), "busy loops"))
    busy = ", ".join(f"{text.number(time / times[0])} times as long beside {loops} busy "
                     f"{'loop' if loops == 1 else 'loops'}" for loops, time in times.items() if loops)
    holds = all(times[loops] <= most * times[0] for loops, most in MOST_TIMES_AS_LONG.items() if loops in times)
    asked = text.listed(f"{most:g}" for most in MOST_TIMES_AS_LONG.values())
    return (f"A step of Large Rock Pile with `{'+'.join(BEST)}` takes {text.number(times[0])} ms on two threads of an idle "
            f"machine, and {busy} of other login sessions; asked: at most {asked} times, {text.holds(holds)} (`{BUSY[1]}`; "
            f"{stored.origin(BUSY[0])}).")


def idle_cost(stored):
    shares = thread_times.sleeping_over_awake(need(stored.table(*IDLE), "threads that sleep", "awake_t_s_ms"))
    told = text.listed(f"{text.number(share)} times as long as with threads that never sleep on {scene.replace('_', ' ')}"
                       for scene, share in shares.items())
    return f"On an idle machine solves on two threads take {told} (medians; `{IDLE[1]}`; {stored.origin(IDLE[0])})."


def compare_builds(stored):
    rows = need(stored.table(*BEFORE), "steps of two builds")
    earlier, _ = builds.commits(rows)
    threads = threads_in_words(tuple(sorted({row["threads"] for row in rows})))
    serial = ", the last whose solver was serial but for parts," if builds.SERIAL.startswith(earlier) else ""
    return (f"Steps from zero impulses on {threads} by commit {earlier}{serial} and by this solver "
            f"({stored.origin(BEFORE[0])}; `{BEFORE[1]}`): {builds.summary(builds.changes(rows))}.\n\n{builds.markdown(rows)}")


def cold_starts(stored):
    rows = [row for row in need(stored.table(*COLD), "cold starts") if int(row["rows"]) >= COLD_ROWS]
    need(rows, f"at least {COLD_ROWS} rows")
    parts = []
    for start in ("cold", "warm"):
        counts = sorted(int(row[f"factorizations_{start}"]) for row in rows)
        parts.append(f"{start}: median {statistics.median(counts):.0f}, at most {counts[-1]}, and at most 8 on "
                     f"{sum(count <= 8 for count in counts)}")
    return (f"Factorisations of `exact` on the {len(rows)} recorded steps of Rock Pile with at least {COLD_ROWS} rows, "
            f"cfm 1e-5 (`{COLD[1]}`): {'; '.join(parts)}.")


def _cost(rows):
    """Mean time of a solve in ms and the median residual, of rows that have both."""
    rows = [row for row in rows if math.isfinite(row.number("t_s_ms") + row.number("residual_m_per_s"))]
    return (statistics.fmean(row.number("t_s_ms") for row in rows),
            statistics.median(row.number("residual_m_per_s") for row in rows))


def speed_accuracy(stored):
    """The fastest direct solver against numbers of Gauss-Seidel sweeps: time and error."""
    direct, sweeps = [], {}
    for run in stored.runs(*SOLVERS):
        name = run.steps_path.parent.name
        if name.startswith("pgs_"):
            sweeps[int(name.removeprefix("pgs_"))] = _cost(run.rows)
        elif name == "direct":
            for solver in dict.fromkeys(row["solver"] for row in run.rows):
                rows = [row for row in run.rows if row["solver"] == solver]
                if all(row["status"] == "ok" for row in rows):
                    direct.append((_cost(rows)[0], solver))
    time, solver = min(need(direct, "a direct solver"))
    shown = [[count, text.number(cost), text.number(cost / time), text.number(error)]
             for count, (cost, error) in sorted(need(sweeps, "Gauss-Seidel").items())]
    return (f"On 200 rocks, one thread, `{solver}` solves a step exactly in {text.number(time)} ms on the mean, the fastest "
            f"of the direct solvers; projected Gauss-Seidel ({stored.origin(SOLVERS[0])}):\n\n" +
            text.table(["sweeps", "ms", f"of the time of `{solver}`", "median residual, m/s"], shown))


BLOCKS = {"two_threads": two_threads, "compare_builds": compare_builds, "solver_benchmark": solver_benchmark,
          "cold_starts": cold_starts, "speed_accuracy": speed_accuracy, "dense": dense, "busy_machine": busy_machine,
          "idle_cost": idle_cost, "model": model, "modelled_workers": modelled_workers}
