"""Small made-up results, written as `cleave run` writes them, and a way to run the scripts."""
import csv
import json
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCRIPTS = ROOT / "scripts"
PROGRAM = os.environ.get("CLEAVE_PROGRAM", str(ROOT / "build" / "release" / "cleave"))
sys.path.insert(0, str(SCRIPTS))

from cleave_scripts.results.paper import (ASKED_PARTITIONERS, ASKED_REFINERS, COMBINATIONS,  # noqa: E402
                                          PARTITIONERS, REFINERS, SCENES)

STEPS = range(0, 500, 50)


def command_files():
    """Every command of scripts/, those in folders of their own too."""
    return sorted(path for path in (*SCRIPTS.iterdir(), *(SCRIPTS / "slurm").iterdir()) if path.is_file())


def asked_partitioners(text):
    """The names that a stand-in for the program runs where it is asked for these."""
    return PARTITIONERS if text == ASKED_PARTITIONERS else text.split(",")


def asked_refiners(text):
    return REFINERS if text == ASKED_REFINERS else text.split(",")


def good_row(scene, step, partitioner, refiner):
    """A row that breaks no criterion; t_s depends on the combination, so that means can be told apart."""
    names = (partitioner, refiner)
    rank = COMBINATIONS.index(names) if names in COMBINATIONS else len(COMBINATIONS)
    return {
        "scene": scene,
        "seed": 1,
        "step": step,
        "partitioner": partitioner,
        "refiner": refiner,
        "solver": "schur",
        "kernel": "schur-rows",
        "friction": "box",
        "threads": 2,
        "status": "ok",
        "max_bodies": 25,
        "tau_mr": 10,
        "tau_mix": 0.5,
        "max_growth": 0.2,
        "bodies": {"chain_drop": 100, "log_tower": 201, "large_rock_pile": 600}.get(scene, 200),
        "steps": 500,
        "contacts": 40,
        "parts": 4,
        "max_part_bodies_before": 25,
        "max_part_bodies": 30 if refiner == "fm" else 25,
        "interface_rows_before": 60,
        "interface_rows": 60 if refiner == "none" else 50,
        "interface_unknowns": 45,
        "t_pr_ms": 0.125,
        "t_s_ms": 10 + rank,
        "t_s_min_ms": 9 + rank,
        "t_s_other_ms": 0.5,
        "t_s_waiting_ms": 0.01,
        "residual_m_per_s": 1e-12,
        "largest_free_velocity_m_per_s": 2.5,
        "velocity_spread_m_per_s": 1e-12,
        "problem_hash": f"a{step:015d}",
        "state_hash": f"b{step:015d}",
    }


def matrix(scene, steps=STEPS, combinations=COMBINATIONS):
    return [good_row(scene, step, *names) for step in steps for names in combinations]


def write_steps(directory, rows):
    directory = pathlib.Path(directory)
    directory.mkdir(parents=True, exist_ok=True)
    path = directory / "steps.csv"
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    return path


def touch_recorded(given):
    """Empty problem files where `cleave record` with these options leaves its own."""
    out = pathlib.Path(given["--out"])
    out.mkdir(parents=True, exist_ok=True)
    for step in given["--at"].split(","):
        (out / f"{given['--scene']}_step{int(step):06}.h5").touch()


def write_manifest(directory, **entries):
    (pathlib.Path(directory) / "manifest.json").write_text(json.dumps(entries), encoding="utf-8")


def write_matrix(directory, change=None):
    """All four scenes. change(rows of rock_pile) may spoil one of them in place or return other rows."""
    for scene in SCENES:
        rows = matrix(scene)
        if change and scene == "rock_pile":
            rows = change(rows) or rows
        write_steps(pathlib.Path(directory) / scene, rows)


def run_script(name, *arguments, **options):
    return subprocess.run([str(SCRIPTS / name), *map(str, arguments)],
                          capture_output=True,
                          text=True,
                          timeout=900,  # ends what hangs; a busy machine takes its time
                          check=False,
                          **options)
