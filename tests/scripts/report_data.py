"""A small made-up tree of output directories as `scripts/report` reads it, with known figures."""
import math
import pathlib

from synthetic import good_row, write_manifest, write_steps

from cleave_scripts.figures.tree import CLAIMS_FILE
from cleave_scripts.results.paper import PARTITIONERS, REFINERS, SCENES, load_paper_table1

PAPER = load_paper_table1()
STEPS = range(9, 90, 10)
# Figures of another script's tables.
OF_TRADEOFF = ("price_of_accuracy", "time_to_accuracy", "crossover", "accuracy_profile", "tradeoff_motion")
STAGES = ("analyze", "factor_local", "factor_interface")


def report_row(scene, step, partitioner, refiner, **changes):
    """The paper's own times with a little that changes from step to step; everything the figures need."""
    t_s, t_pr = PAPER.get((scene, partitioner, refiner), (10.0, 1.0))
    t_s *= 1 + 0.1 * math.sin(step)
    row = good_row(scene, step, "mindp", "none") | {
        "partitioner": partitioner,
        "refiner": refiner,
        "threads": 1,
        "repeat_count": 3,
        "bodies": 200,
        "rows": 900,
        "interface_rows": round(30 * t_s**(1 / 3)),
        "factor_mflop_local": 1.0,
        "factor_mflop_interface": 0.1 * t_s,
        "factorizations": 4,
        "part_mass_ratio_max": 1 if partitioner == "mr" else 100,
        "t_s_ms": t_s,
        "t_s_min_ms": 0.98 * t_s,
        "t_pr_ms": t_pr / 20,
        "t_s_other_ms": 0.1 * t_s
    }
    row |= {f"t_s_{stage}_ms": 0.3 * t_s for stage in STAGES}
    row |= {f"t_s_model_p{workers}_ms": t_s * (0.5 + 0.5 / workers) for workers in (1, 2, 4, 8, 16, 32, 64)}
    return row | changes


def rows_of(scene, partitioners=PARTITIONERS, refiners=REFINERS, steps=STEPS, **changes):
    return [
        report_row(scene, step, partitioner, refiner, **changes) for step in steps
        for partitioner in partitioners for refiner in refiners
    ]


def manifest(scene, **options):
    return {
        "state": "complete",
        "utc_start": "2026-01-01T00:00:00Z",
        "build": {
            "git_hash": "0123456789ab"
        },
        "machine": {
            "cpu_model": "Some_CPU",
            "cores": 6
        },
        "options": {
            "scene": scene,
            "threads": 1,
            "steps": 90,
            "sweeps": 5,
            "strategy": "",
            "kernel": "",
            "reuse-analysis": False,
            "skip": 0,
            **options
        }
    }


def write_run(directory, rows, **options):
    write_steps(directory, rows)
    write_manifest(directory, **manifest(rows[0]["scene"], **options))


def whole_system(solver, **changes):
    return rows_of("rock_pile", ("-",), ("-",), solver=solver, kernel=solver, **changes)


def write_claims(directory):
    """hidden_choices_claims.csv, of two claims."""
    directory = pathlib.Path(directory)
    directory.mkdir(parents=True, exist_ok=True)
    (directory / CLAIMS_FILE).write_text("claim,row,by,max_bodies,order,holds,fails,cannot_tell\n" + "".join(
        f"Claim {claim},part,{by},{size},{order},{claim + size // 10},{4 - claim},{claim}\n"
        for claim in (1, 2) for by in ("cut", "time") for size in (10, 25) for order in ("scene", "random")))


def write_tree(directory):
    """Four scenes, a two-thread run, three sizes, four solvers in four runs, a ladder,
    and what hidden choices do to two claims."""
    directory = pathlib.Path(directory)
    write_claims(directory)
    for scene in SCENES:
        write_run(directory / scene, rows_of(scene))
    write_run(
        directory / "two_threads",
        [dict(row, threads=2, t_s_ms=0.6 * row["t_s_ms"]) for row in rows_of("rock_pile", ("mindp", "mix"))],
        threads=2)
    for size in (50, 100, 200):
        scale = {"none": (size / 50)**2, "kl": 0.9 * (size / 50)**2, "fm": 0.8 * (size / 50)**1.5}
        rows = [
            dict(row, bodies=size, t_s_ms=scale[row["refiner"]], t_s_min_ms=scale[row["refiner"]])
            for row in rows_of("rock_pile", ("mindp", "mix"))
        ]
        write_run(directory / "scaling" / f"bodies_{size}", rows, bodies=size)
    bodies_kernel = rows_of("rock_pile", ("mindp", "mix"), ("none", "fm"),
                            solver="pivot:schur-bodies",
                            kernel="schur-bodies")
    write_run(directory / "solvers" / "direct", bodies_kernel + whole_system("monolithic", t_s_ms=5))
    for sweeps, residual in ((10, 1e-2), (100, 1e-5)):
        write_run(directory / "solvers" / f"pgs_{sweeps}",
                  whole_system("pgs", t_s_ms=sweeps / 10, residual_m_per_s=residual, status="not_converged"),
                  sweeps=sweeps)
    write_ladder(directory)
    write_tradeoff(directory)
    write_motions(directory)


def write_motions(directory):
    """A chain that two solvers have moved, one of them in two numbers of sweeps."""
    lines = ["scene,mover,step,time_s,rows,iterations,residual_m_per_s,max_penetration_m,joint_drift_m,height_m,"
             "kinetic_energy_j,potential_energy_j,t_s_ms,status,bodies"]
    for mover, t_s_ms, drift_m in (("exact", 1, 1e-4), ('"pgs, 20 sweeps"', 0.5, 2e-3), ('"pgs, 100 sweeps"', 2.5, 3e-4)):
        lines += [f"chain_drop,{mover},{step},1,900,9,1e-3,1e-4,{drift_m},1.5,0.1,{600 - 1e4 * drift_m},{t_s_ms},ok,100"
                  for step in (9, 19)]
    (directory / "tradeoff_motion.csv").write_text("\n".join(lines) + "\n")


def write_tradeoff(directory):
    """Piles of three sizes, two compliances and two mass ratios."""
    lines = ["series,scene,bodies,mass_ratio,cfm,step,rows,solver,partitioner,refiner,iterations,residual_m_per_s,"
             "largest_free_velocity_m_per_s,t_pr_ms,t_s_ms,status"]
    for bodies, mass_ratio, cfm in ((50, 1, 1e-6), (100, 1, 1e-6), (200, 1, 1e-6), (200, 1, 1e-8), (200, 100, 1e-6)):
        pile = f"paper,rock_pile,{bodies},{mass_ratio},{cfm},200,{10 * bodies}"
        lines.append(f"{pile},exact,-,-,9,1e-13,1,nan,{bodies / 50},ok")
        for power in range(1, 6):
            lines.append(f"{pile},pgs@until=1e-{power}@sweeps=3000,-,-,{10 * power},9e-{power + 1},1,nan,"
                         f"{power * bodies / 100},not_converged")
    (directory / "tradeoff.csv").write_text("\n".join(lines) + "\n")


def write_ladder(directory):
    lines = ["rung,parameter,value,solver,status,residual_m_per_s"]
    for rung, parameter, values in (("stack", "mass_ratio", (1, 10, 100, 1000)), ("stiff", "cfm", (1e-4, 1e-8,
                                                                                                   0))):
        for index, value in enumerate(values):
            for solver, held in (("exact", 9), ("pgs", 1)):
                status = "ok" if index < held else "not_converged"
                lines.append(f"{rung},{parameter},{value},{solver},{status},1e-12")
    (directory / "ladder.csv").write_text("\n".join(lines) + "\n")
