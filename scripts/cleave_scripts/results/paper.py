"""The paper's experiment, from scripts/data: its sets, its combinations and its Table 1."""
import pathlib
import tomllib

from cleave_scripts.results.steps import load_steps

DATA = pathlib.Path(__file__).resolve().parents[2] / "data"
PAPER = tomllib.loads((DATA / "paper.toml").read_text(encoding="utf-8"))

SCENES = tuple(PAPER["bodies"])
PARTITIONERS, REFINERS = tuple(PAPER["partitioners"]), tuple(PAPER["refiners"])
COMBINATIONS = tuple((partitioner, refiner) for partitioner in PARTITIONERS for refiner in REFINERS)
# How the program is asked for these sets.
ASKED_PARTITIONERS, ASKED_REFINERS = "paper", "paper"
PLAIN, BEST = tuple(PAPER["plain"]), tuple(PAPER["best"])


def load_paper_table1(path=DATA / "paper_table1.csv"):
    """(scene, partitioner, refiner) -> (t_s_ms, t_pr_ms) as the paper printed them."""
    rows, _ = load_steps(path, ("scene", "partitioner", "refiner", "t_s_ms", "t_pr_ms"))
    return {(row["scene"], row["partitioner"], row["refiner"]): (row.number("t_s_ms"), row.number("t_pr_ms"))
            for row in rows}
