"""What scripts/partition_over_time measured: partitioning time and cut of parts that are taken over, against those of parts
made anew in every step."""
import collections
import dataclasses

FRESH = "always"
RULES = (FRESH, "on-change", "every:5", "every:20", "drift:0.05", "drift:0.2")
SPLITS = (("mix", "fm"), ("multilevel@effort=best", "none"))
ORIGINS = ("fresh", "repaired", "kept")


@dataclasses.dataclass(frozen=True)
class Course:
    """Over all steps of a scene with a constraint, under one rule."""
    t_pr_ms: float  # sum
    t_s_ms: float
    interface_rows: int  # sum
    shares: dict  # {origin: part of the steps}

    def saving(self, always):
        return always.t_pr_ms / self.t_pr_ms

    def rows(self, always):
        return self.interface_rows / always.interface_rows

    def t_s(self, always):
        return self.t_s_ms / always.t_s_ms


def course_of(steps):
    origins = collections.Counter(step["partition_origin"] for step in steps)
    return Course(sum(float(step["t_pr_ms"]) for step in steps), sum(float(step["t_s_ms"]) for step in steps),
                  sum(int(step["interface_rows"]) for step in steps),
                  {origin: origins[origin] / len(steps) for origin in ORIGINS})


def courses(rows):
    """{(scene, partitioner, refiner): {rule: Course}}"""
    found = {}
    for row in rows:
        rules = found.setdefault((row["scene"], row["partitioner"], row["refiner"]), {})
        rules.setdefault(row["repartition"], []).append(row)
    return {key: {rule: course_of(steps) for rule, steps in rules.items()} for key, rules in found.items()}
