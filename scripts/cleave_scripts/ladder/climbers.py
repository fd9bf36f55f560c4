"""Who climbs the ladder, from scripts/data/ladder.toml; besides, any solver whose name says strategy or parameters."""
import tomllib

from cleave_scripts.results.paper import DATA

CLIMBERS = {entry["name"]: entry for entry in tomllib.loads((DATA / "ladder.toml").read_text(encoding="utf-8"))["climber"]}
OWN_BOUNDS = tuple(name for name, entry in CLIMBERS.items() if entry.get("own_bounds"))


def is_climber(name):
    return name in CLIMBERS or any(sign in name for sign in ":@")


def solver_options(name):
    """What cleave is given: the solver also advances the world."""
    entry = CLIMBERS.get(name, {"solver": name})
    return ("--solver", entry["solver"], "--advance", entry["solver"], *entry.get("options", ()))
