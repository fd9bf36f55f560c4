"""What scripts/model_savings measured: every scene with all rows (`full`) and with those that can matter (`auto`)."""
import dataclasses
import statistics

# What is run: options of `cleave run`.
CASES = {
    "chain drop": ("--scene", "chain_drop"),
    "log tower": ("--scene", "log_tower"),
    "rock pile": ("--scene", "rock_pile"),
    "rock pile without friction": ("--scene", "rock_pile", "--mu", 0),
    "large rock pile": ("--scene", "large_rock_pile"),
    "silo": ("--scene", "silo"),
}
KEY = ("scene", "bodies", "mu")


@dataclasses.dataclass(frozen=True)
class Savings:
    """Of one scene. Ratios are auto over full, step by step, of the medians over rounds."""
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
        shares = (sum(int(row[f"model_rows_{name}"]) for row in planned) / total for name in ("left_out", "at_rest", "returned"))
        ratios = [auto[step] / full[step] for step in full]
        found[key] = Savings(statistics.fmean(full.values()), sum(auto.values()) / sum(full.values()), min(ratios), max(ratios), *shares,
                             max(float(row["velocity_spread_m_per_s"]) for row in planned))
    return found
