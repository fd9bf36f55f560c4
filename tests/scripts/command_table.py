"""Every command of scripts/ as the tests of bad input have to know it: what it takes, and what it reads.

Words may hold {tree}, output directories of good rows; {empty}, a directory; {file}, a file; {out}, where nothing is yet.
"""
import dataclasses


@dataclasses.dataclass(frozen=True)
class Command:
    options: dict  # option: its kind, a key of BAD; "" where it takes no value
    given: tuple = ()  # what it cannot do without
    reads: tuple = ()  # which words of `given` are directories that it reads
    prints: tuple = ()  # words with which it prints results of {tree} at once
    runs: bool = False  # the program, which CLEAVE_PROGRAM names
    passes_on: bool = False  # options that it does not know are for another program


# What is wrong with a value of every kind; NAME is replaced by a name that is right.
BAD = {
    "": (),
    "count": ("", "0", "-1", "nan", "3,", "1e3"),
    "counts": ("", "3,", "3,,4", "0", "-1", "nan"),
    "seed": ("", "-1", "nan", "3,"),
    "seeds": ("", "3,", "-1", "nan"),
    "seconds": ("", "0", "-1", "nan", "inf", "3,"),
    "compliances": ("", "0,", "-1", "nan", "soft"),
    "range": ("", "1,", "2,1", "nan,1", "x"),
    "scenes": ("", "chain_drop,", "rock_pill"),
    "recorded scenes": ("", "silo,", "sillo"),
    "tables of friction": ("", "motion,", "motions"),
    "tables of the tradeoff": ("", "motion,", "solver"),
    "rungs": ("", "no_contact,", "no_contract"),
    "climbers": ("", "exact,", "exakt", "nope:nope"),
    "partitioners": ("", "nope"),
    "constants": ("", "reach,", "reech"),
    "recorded compliances": ("", "0,", "1e-7"),
    "decades": ("", "1e-4,", "1e-15"),
    "piles": ("", "rock_pile,", "log_tower"),
    "rock piles": ("", "200,", "201"),
    "solver": ("", "shur"),
    "format": ("", "markdow"),
    "cones": ("", "eliptic"),
    "commit": ("", "nope", "--all"),
    "condition": ("", "solver", "=schur"),
    "figures": ("", "figure1,", "figure9"),
    "colour": ("", "parts"),
    "fuzz targets": ("", "csv,", "scen"),
    "preset": ("", "relase"),
    "target": ("",),
    "trials": ("", "edits,", "edit"),
    "input directory": ("", "{file}", "{out}/nowhere"),
    "input file": ("", "{out}/nowhere", "{empty}"),
    "output directory": ("", "{file}", "{file}/below/it", "/proc/nowhere", "{out}/" + 300 * "x"),
    "output file": ("", "{empty}", "{file}/below", "/dev/full", "{out}/" + 300 * "x"),
}
# What a misspelt name is like, by the text that was given.
NEAR = {
    "rock_pill": "rock_pile", "no_contract": "no_contact", "exakt": "exact", "reech": "reach", "shur": "schur",
    "markdow": "markdown", "201": "200", "figure9": "figure", "parts": "part",
    "edit": "edits", "scen": "scene", "eliptic": "elliptic", "sillo": "silo", "motions": "motion"
}

MEASURED = {"--out": "output directory"}
SERIES = {"--steps": "count", "--measure-every": "count", "--force": "", **MEASURED}
TIMED = {**SERIES, "--repeats": "count", "--threads": "count", "--seed": "seed"}
COMMANDS = {
    "ablate_interior_point": Command({"--scene": "scenes", "--cfm": "recorded compliances", "--constant": "constants",
                                      **MEASURED}, runs=True),
    "ablation": Command(MEASURED, runs=True),
    "benchmark_dense": Command({"--repetitions": "count", **MEASURED}, runs=True),
    "benchmark_partitioners": Command({"--repetitions": "count", **MEASURED}, runs=True),
    "benchmark_solvers": Command({"--repetitions": "count", "--print-only": "", **MEASURED}, runs=True),
    "busy_machine": Command({"--rounds": "count", **MEASURED}, runs=True),
    "campaign_costs": Command({"--cells": "count", "--rounds": "count", "--paper": "input directory", **MEASURED}, runs=True),
    "check_matrix": Command({"--scene": "scenes", "--min-steps": "count"}, ("{tree}",), ("{tree}",), ("{tree}",)),
    "cold_starts": Command({"--seeds": "seeds", **MEASURED}, runs=True),
    "compare_builds": Command({"--commit": "commit", "--threads": "count", "--rounds": "count", **MEASURED}, runs=True),
    "coulomb_peers": Command({"--scene": "recorded scenes", **MEASURED}, runs=True),
    "elimination_orders": Command(MEASURED, runs=True),
    "extremes": Command({"--cfm": "compliances", "--seeds": "seeds", **SERIES}, runs=True),
    "extremes_table": Command({"--csv": "output file"}, ("{extremes}",), ("{extremes}",), ("{extremes}",)),
    "fuzz": Command({"--minutes": "count", "--target": "fuzz targets", "--minimise": "", "--page": "output file", **MEASURED}),
    "idle_cost": Command({"--rounds": "count", **MEASURED}, runs=True),
    "karger": Command(MEASURED, runs=True),
    "ladder": Command({"--full": "", "--rung": "rungs", "--solver": "climbers", "--steps": "count", "--timeout": "seconds",
                       "--jobs": "count", "--force": "", **MEASURED}, runs=True),
    "large_scenes": Command({"--piles": "counts", "--silos": "counts", "--rounds": "count", **MEASURED}, runs=True),
    "model_savings": Command({"--steps": "count", "--rounds": "count", **MEASURED}, runs=True),
    "modelled_workers": Command({"--rounds": "count", **MEASURED}, runs=True),
    "partition_objectives": Command({"--rounds": "count", "--threads": "count", **MEASURED}, runs=True),
    "partition_over_time": Command({"--steps": "count", **MEASURED}, runs=True),
    "partition_regret": Command({"--rounds": "count", "--threads": "count", **MEASURED}, runs=True),
    "partition_worth": Command({"--rounds": "count", "--repeats": "count", **MEASURED}, runs=True),
    "peers": Command({"--bodies": "counts", "--rounds": "count", "--timeout": "seconds", **MEASURED}, runs=True),
    "peers_mujoco": Command({"--bodies": "count", "--cone": "cones", "--repeats": "count", "--later": "count", **MEASURED},
                            runs=True),
    "readme_figures": Command(MEASURED, ("{tree}",), ("{tree}",)),
    "readme_tables": Command({"--check": "", "--root": "input directory"}, ("--root", "{empty}"), ("{empty}",)),
    "reference": Command({"--root": "input directory"}, ("--root", "{empty}"), ("{empty}",), runs=True),
    "render_figures": Command({"--only": "figures", "--every": "count", "--columns": "count", "--colour": "colour",
                               "--width": "count", **MEASURED}, ("{tree}",), ("{tree}",)),
    "report": Command({"--solver": "solver"}, ("{tree}",), ("{tree}",)),
    "report_runs": Command(TIMED, runs=True),
    "reproduce": Command({"--full": "", "--scene": "scenes", **TIMED}, runs=True),
    "running_simulation": Command({"--steps": "count", "--rounds": "count", **MEASURED}, runs=True),
    "scaling": Command({"--sizes": "counts", "--partitioner": "partitioners", **TIMED}, runs=True),
    "setup": Command({"--preset": "preset", "--target": "target"}),
    "table1": Command({"--format": "format", "--where": "condition"}, ("{tree}",), ("{tree}",), ("{tree}",)),
    "test": Command({"--preset": "preset"}, passes_on=True),
    "friction_cost": Command({"--rocks": "rock piles", "--cfm": "decades", "--scene": "piles", "--steps": "count",
                              "--measure-every": "count", "--rounds": "count", **MEASURED}, runs=True),
    "friction_forms": Command(MEASURED, runs=True),
    "friction_models": Command({"--scene": "scenes", "--tables": "tables of friction", "--steps": "count", **MEASURED},
                               runs=True),
    "hidden_choices": Command({"--spec": "input file", "--report": "output directory", **MEASURED}, runs=True),
    "slurm/submit": Command({"--tasks": "count", "--dry-run": "", "--out": "output directory"},
                            ("{file}", "--tasks=1", "--out={out}"), runs=True),
    "torture": Command({"--minutes": "count", "--seed": "seed", "--trials": "trials", "--count": "count", "--only": "seed",
                        "--patience": "count", "--side-by-side": "count", **MEASURED}, ("--minutes", "1"), runs=True),
    "tradeoff": Command({"--most-sweeps": "count", "--steps": "count", "--tables": "tables of the tradeoff",
                         "--threads": "count", **MEASURED}, runs=True),
    "two_threads": Command({"--bodies": "rock piles", "--rounds": "count", **MEASURED}, runs=True),
    "validate_model": Command({"--limit": "range"}, ("{tree}", "{tree}"), ("{tree}",)),
    "view": Command({"--out": "output file"}, ("{tree}",), ("{tree}",)),
}
