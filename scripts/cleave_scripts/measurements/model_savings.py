"""What scripts/model_savings measured: every scene with all rows (`full`) and with those that can matter (`auto`)."""
import dataclasses
import re
import statistics

from cleave_scripts.measurements.every_scene import MECHANISM_OPTIONS
from cleave_scripts.results.programs import ROOT


@dataclasses.dataclass(frozen=True)
class Case:
    """What is run."""
    options: tuple  # of `cleave run`
    first: int = 0  # measured from this step on
    steps: int | None = None  # None: as many as are asked for


# Scenes as files, made of those that the project keeps: the tower of log_tower, whose ball is never let go, and the chain of
# chain_drop, laid out on the floor. Friction with compliance creeps, so that a heap which it holds never rests: the chain that
# has dropped does without it.
STANDING_TOWER = "standing_tower.toml"
LAID_CHAIN = "laid_chain.toml"
CASES = {
    "chain drop": Case(("--scene", "chain_drop")),
    "log tower": Case(("--scene", "log_tower")),
    "rock pile": Case(("--scene", "rock_pile")),
    "rock pile without friction": Case(("--scene", "rock_pile", "--mu", 0)),
    "large rock pile": Case(("--scene", "large_rock_pile")),
    "silo": Case(("--scene", "silo")),
    "crane": Case(("--scene", "crane", *MECHANISM_OPTIONS)),
    "mixed site": Case(("--scene", "mixed_site", *MECHANISM_OPTIONS)),
    "log tower at rest": Case(("--scene", "file@path=" + STANDING_TOWER), 300, 600),
    "chain drop at rest": Case(("--scene", "chain_drop", "--mu", 0), 16000, 16500),
    "chain drop, laid out": Case(("--scene", "file@path=" + LAID_CHAIN), 1200, 1500),
    "chain drop, heaped": Case(("--scene", "chain_drop"), 3000, 3500),
}
KEY = ("case", "bodies", "mu")


def _scene_file(name):
    return (ROOT / "scenarios" / "files" / name).read_text()


def _without(tables, text):
    return re.sub(rf"^\[\[{tables}\]\]\n(?:(?!\[).*\n?)*", "", text, flags=re.MULTILINE)


def standing_tower():
    """Text of a scene file: that of log_tower without its events."""
    return _without("event", _scene_file("log_tower.toml"))


def laid_chain():
    """Text of a scene file: that of chain_drop with a floor for its funnel, the chain lying on it."""
    text = _without("plane", _scene_file("chain_drop.toml"))
    radius_m = re.search(r"^radius_m = (\S+)$", text, flags=re.MULTILINE)[1]
    return "[ground]\n" + re.sub(r", 2\](,?)$", rf", {radius_m}]\1", text, flags=re.MULTILINE)


@dataclasses.dataclass(frozen=True)
class Savings:
    """Of one case. Ratios are auto over full, step by step, of the medians over rounds."""
    full_ms: float  # mean over steps
    ratio: float  # of the means
    least: float  # over steps
    most: float
    left_out: float  # share of all rows
    at_rest: float
    returned: float
    largest_difference_m_per_s: float


def _median_ms(rows):
    by_step = {}
    for row in rows:
        by_step.setdefault(int(row["step"]), []).append(float(row["t_s_ms"]))
    return {step: statistics.median(times) for step, times in by_step.items()}


def savings(rows):
    """{key: Savings}"""
    found = {}
    for key in dict.fromkeys(tuple(row[name] for name in KEY) for row in rows):
        mine = [row for row in rows if tuple(row[name] for name in KEY) == key]
        full, auto = (_median_ms([row for row in mine if row["model"] == model]) for model in ("full", "auto"))
        planned = [row for row in mine if row["model"] == "auto"]
        total = sum(int(row["rows"]) for row in planned)
        shares = (sum(int(row[f"model_rows_{name}"]) for row in planned) / total
                  for name in ("left_out", "at_rest", "returned"))
        ratios = [auto[step] / full[step] for step in full]
        found[key] = Savings(statistics.fmean(full.values()), sum(auto.values()) / sum(full.values()), min(ratios), max(ratios),
                             *shares, max(float(row["velocity_spread_m_per_s"]) for row in planned))
    return found
