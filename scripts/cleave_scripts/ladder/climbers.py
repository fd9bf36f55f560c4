"""Who climbs the ladder, from scripts/data/ladder.toml; besides, any solver whose name says strategy or parameters."""
import dataclasses
import tomllib

from cleave_scripts.results.paper import DATA


@dataclasses.dataclass(frozen=True)
class Climber:
    """The solver also advances its world."""
    name: str  # in ladder.csv
    solver: str  # as the program names it, with its parameters
    friction: str = "box"
    own_bounds: bool = False  # it finds its own friction bounds


CLIMBERS = {entry["name"]: Climber(**entry)
            for entry in tomllib.loads((DATA / "ladder.toml").read_text(encoding="utf-8"))["climber"]}
OWN_BOUNDS = tuple(climber.name for climber in CLIMBERS.values() if climber.own_bounds)


def is_climber(name):
    return name in CLIMBERS or any(sign in name for sign in ":@")


def climber_of(name):
    return CLIMBERS.get(name) or Climber(name, name)
