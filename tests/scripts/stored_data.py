"""Small made-up results as scripts/reference stores them, for the generated parts of the READMEs."""
import csv
import json

from synthetic import COMBINATIONS, matrix, write_steps

from cleave_scripts.results.paper import SCENES

BUILD = {"git_hash": "0123456789abcdef", "git_dirty": "false"}
MACHINE = {"cpu_model": "Some CPU", "cores": 2}


def write_csv(path, rows):
    path.parent.mkdir(parents=True, exist_ok=True)
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def write_provenance(root, *names):
    entry = {"command": "scripts/x", "seconds": 90, "build": BUILD, "machine": MACHINE}
    (root / "provenance.json").write_text(json.dumps({"files": {name: entry for name in names}}))


# Scene, bodies, cfm, step, solver, combination: t_s in ms of one thread, of two, and of one beside another.
TIMES = {("rock_pile", 200, 1e-5, 200, "exact", "mix", "fm"): (10, 6.25, 12.5),
         ("rock_pile", 200, 1e-5, 200, "pivot:schur-bodies", "mix", "fm"): (10, 5, 10),
         ("rock_pile", 200, 1e-10, 200, "exact", "mix", "fm"): (30, 20, 30),
         ("rock_pile", 200, 1e-10, 200, "pivot:schur-bodies", "mix", "fm"): (30, 20, 32),
         **{("large_rock_pile", 600, 1e-5, step, "schur", *names): times for step in (100, 300)
            for names, times in ((("mindp", "none"), (100, 50, 100)), (("mix", "none"), (90, 50, 90)),
                                 (("mix", "fm"), (80, 60, 100)))}}


# The same of solvers that iterate, which were not always measured.
SWEEPS_TIMES = {("large_rock_pile", 600, 1e-5, step, solver, "-", "-"): times for step, beside in ((100, 20), (300, 22))
                for solver, times in (("pgs-colored@sweeps=100", (20, 12.5, beside)), ("apgd@sweeps=100", (10, 10, beside)))}


def two_threads_rows(times=TIMES):
    """The third round is slow."""
    return [{"scene": scene, "bodies": bodies, "cfm": cfm, "step": step, "solver": solver, "partitioner": partitioner,
             "refiner": refiner, "threads": threads, "processes": processes, "round": number,
             "t_s_ms": time + (1000 if number == 3 else 0)}
            for (scene, bodies, cfm, step, solver, partitioner, refiner), of_ways in times.items()
            for time, (threads, processes) in zip(of_ways, ((1, 1), (2, 1), (1, 2))) for number in (1, 2, 3)]


def two_threads(root):
    write_csv(root / "two_threads.csv", two_threads_rows())


def running_simulation_rows(sessions=(0, 1)):
    """The third round is slow, and one of its solves misses the limit."""
    return [{"scene": "rock_pile", "bodies": 200, "step": step, "session": session, "round": number, "rows": 1000 * step,
             "factorizations": 3, "factor_reuses": 1, "cg_iterations": 2, "t_s_ms": t_s_ms if number < 3 else 50,
             "sweep_ms": 0.02 * step if number < 3 else 9, "status": "not_converged" if (number, step) == (3, 2) else "ok"}
            for session in sessions for number in (1, 2, 3) for step, t_s_ms in ((1, 1), (2, 5))]


# Scene, bodies, threads: rows, factorisations, t_s in ms.
LARGE = {("rock_pile", 10000, 1): (100000, 5, 850), ("rock_pile", 100000, 1): (1000000, 10, 28900),
         ("rock_pile", 10000, 2): (100000, 5, 500), ("rock_pile", 100000, 2): (1000000, 10, 15000),
         ("silo", 10000, 1): (300000, 4, 900), ("silo", 10000, 2): (300000, 4, 600)}


def large_scenes_rows():
    """Everything takes ten times as long in the third round, dense factorisations too;
    a sweep takes a millisecond of every 10000 rocks."""
    exact = {(*key, "exact"): found for key, found in LARGE.items()}
    swept = {("rock_pile", bodies, 1, "pgs@sweeps=300"): (10 * bodies, 0, 0.03 * bodies) for bodies in (10000, 100000)}
    return [{"scene": scene, "bodies": bodies, "solver": solver, "threads": threads, "round": number,
             "rows": rows, "factorizations": factorizations, "kinetic_energy_j": 200, "t_s_ms": t_s_ms * slow,
             "t_s_waiting_ms": 0.05 * t_s_ms * slow, "t_s_factor_local_ms": 100 * slow / threads, "factor_mflop_local": 1100,
             "factor_mflop_done": 4000, "dissection_mflop": 1000 if scene == "silo" else "nan",
             "dense_gflop_per_s": 50 * threads / slow, "peak_memory_mb": 2 * bodies / 100 + number}
            for number, slow in ((1, 1), (2, 1), (3, 10))
            for (scene, bodies, threads, solver), (rows, factorizations, t_s_ms) in (exact | swept).items()]


def cold_starts(root):
    rows = [{"seed": 1, "step": step, "rows": 500 + 500 * step, "factorizations_cold": 4 + 2 * step,
             "factorizations_warm": 3} for step in range(5)]
    write_csv(root / "cold_starts.csv", rows)


def extremes(root, spoiled=None):
    rows = [{"mass_ratio": ratio, "scene": "rock_pile", "cfm": cfm, "seed": 1, "status": "ok", "factorizations": count}
            for ratio in ("1", "1e6") for cfm, count in (("1e-4", 20), ("1e-4", 30), ("0", 90))]
    if spoiled:
        rows[0]["status"] = spoiled
    write_csv(root / "extremes.csv", rows)


LADDER = (("heavy_top", "on_axis", "1"), ("heavy_top", "on_axis", "1e6"), ("heavy_top_off_axis", "off_axis", "1"),
          ("chain_swing", "-", "100"))


def ladder(root, heavy_status="ok", swing="step_too_long"):
    rows = [{"rung": rung, "setup": setup, "parameter": "mass-ratio", "value": value, "solver": solver, "steps": 600,
             "height_error_m": 6e-6, "sag_m": 1.2e-4, "status": heavy_status if value == "1e6" else "ok",
             "physics": "height" if solver == "pgs_20" else swing if rung == "chain_swing" else "ok"}
            for rung, setup, value in LADDER for solver in ("exact", "pgs_20", "ode-step_pyramid")]
    write_csv(root / "ladder" / "ladder.csv", rows)
    write_csv(root / "ladder" / "ladder_full_exact.csv", [row for row in rows if row["solver"] == "exact"])


def ablation(root):
    rows = [{"scene": "rock_pile", "bodies": 200, "partitioner": partitioner, "refiner": refiner, "choice": choice,
             "steps": 8, "interface_rows": 100 if choice != "degree whole" else 150}
            for partitioner, refiner in COMBINATIONS
            for choice in ("default", "degree whole", "degree constraints", "as printed", "tau_mr 10.5")]
    write_csv(root / "ablation.csv", rows)


def karger(root):
    """As good as mindp + fm, 40 rows, from 100 trials on with fm, and from 10000 without."""
    cells = [("mindp", "-", refiner, 60 if refiner == "none" else 40) for refiner in ("none", "fm")]
    cells += [("mix", "-", refiner, 50) for refiner in ("none", "fm")]
    cells += [("karger", trials, refiner, 50 - 5 * place + (10 if refiner == "none" else 0) - (10 if trials == 10000 else 0))
              for place, trials in enumerate((1, 10, 100, 1000, 10000)) for refiner in ("none", "fm")]
    rows = [{"scene": "rock_pile", "step": step, "partitioner": partitioner, "trials": trials, "refiner": refiner,
             "karger_method": "-" if trials == "-" else "contract", "interface_rows": cut + sign, "t_pr_ms": 1, "t_s_ms": cut}
            for step, sign in ((100, 1), (200, -1)) for partitioner, trials, refiner, cut in cells]
    rows += [dict(rows[-1], trials=1, karger_method="recursive-bisection", interface_rows=90, step=step) for step in (100, 200)]
    write_csv(root / "karger.csv", rows)


def partition_over_time(root):
    """on-change takes a quarter of the time for 19/20 of the rows, its solves a fifth more; all other rules do as always."""
    rows = [{"scene": "rock_pile", "step": step, "partitioner": "mix", "refiner": "fm", "repartition": rule,
             "partition_origin": "fresh" if rule != "on-change" else origin,
             "interface_rows": 95 if rule == "on-change" else 100, "t_pr_ms": 0.25 if rule == "on-change" else 1,
             "t_s_ms": 12 if rule == "on-change" else 10}
            for step, origin in ((1, "repaired"), (2, "kept"))
            for rule in ("always", "on-change", "every:5", "every:20", "drift:0.05", "drift:0.2")]
    write_csv(root / "partition_over_time.csv", rows)


def partition_benchmark(root):
    """Own rows are 4/5 of METIS's, those of scotch do not count."""
    names = {"mindp+none": 500, "multilevel@effort=best+none": 400, "multilevel@effort=fast+none": 510,
             "mindp@merge-small=true+fm": 550, "mix@merge-small=true+fm": 600, "metis-recursive+none": 500, "scotch+none": None}
    entries = [{"name": f"{graph}/{name}", "cpu_time": (100 if "metis" in name else 12.345) * bodies, "bodies": bodies,
                "edges": 353}
               | ({} if rows is None else {"interface_rows": rows + (100 if name == "mindp+none" and bodies == 200 else 0)})
               for graph, bodies in (("pile_200", 200), ("pile_1000", 1000), ("pile_100000", 100000))
               for name, rows in names.items()]
    (root / "partition_benchmark.json").write_text(json.dumps({"benchmarks": entries}))


def _full_rows(scene):
    rows = [row | {"fallbacks": int(scene == "rock_pile" and row["step"] % 100 == 0),
                   "problem_hash": f"{scene} {row['step']}"} for row in matrix(scene)]
    for row in rows:
        if (row["partitioner"], row["refiner"]) == ("bfs", "fm"):
            row["t_s_ms"] = 1
    return rows


def full(root, spoiled=None):
    """bfs+fm is made the fastest of every scene; every other step of rock_pile falls back."""
    for scene in SCENES:
        rows = _full_rows(scene)
        if spoiled and scene == "rock_pile":
            rows[0]["status"] = spoiled
        write_steps(root / "full" / scene, rows)


def one_thread(root, waiting_ms=0.01):
    """Half of what `full` measured is modelled; the solves of the first row of rock_pile may wait for a core."""
    for scene in SCENES:
        rows = [row | {"threads": 1, "t_s_model_p2_ms": row["t_s_ms"] / 2} for row in _full_rows(scene)]
        if scene == "rock_pile":
            rows[0]["t_s_waiting_ms"] = waiting_ms
        write_steps(root / "report" / "one_thread" / scene, rows)


def solver_runs(root):
    """A direct solver of 4 ms, another of 5 ms, and sweeps that take a tenth of a millisecond each."""
    folder, row = root / "report" / "solvers" / "rocks_200", matrix("rock_pile")[0]
    write_steps(folder / "direct", [row | {"solver": solver, "t_s_ms": time}
                                    for solver, time in (("schur", 5), ("monolithic", 4))])
    for sweeps in (10, 100):
        rows = [row | {"solver": "pgs", "status": "not_converged", "t_s_ms": sweeps / 10, "residual_m_per_s": 1 / sweeps},
                row | {"solver": "pgs", "status": "diverged", "t_s_ms": "nan", "residual_m_per_s": "nan"}]
        write_steps(folder / f"pgs_{sweeps}", rows)
