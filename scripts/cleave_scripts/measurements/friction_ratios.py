"""What the rows of scripts/friction_cost come to: a line a rock pile and compliance under the cone,
and a line a scene under Coulomb's law."""
import dataclasses
import math
import statistics

from cleave_scripts.measurements.friction_cost import BOX, CONE, LAW
from cleave_scripts.table import text

CONE_RATIO, CONE_ITERATIONS = 1.5, 45  # at most
LAW_RATIO, LAW_MISMATCH, LAW_SHARE = 6, 1e-6, 0.95  # at most, at most, at least


@dataclasses.dataclass(frozen=True)
class Cost:
    """Of the same steps under the box and under another model, which dictionaries are by.
    Times of a step are medians over the rounds."""
    steps: int
    t_s_ms: dict  # mean over the steps
    ratios: tuple  # the other model over the box, a step each
    iterations: dict  # most of a step
    unsolved: dict  # steps above the limit
    mismatches: dict  # of the steps in which a contact carries anything

    def ratio_of_sums(self, model):
        return self.t_s_ms[model] / self.t_s_ms[BOX]

    @property
    def median_ratio(self):
        return statistics.median(self.ratios)

    def lawful(self, model):
        """(steps within LAW_MISMATCH of Coulomb's law, steps)"""
        return sum(mismatch <= LAW_MISMATCH for mismatch in self.mismatches[model]), len(self.mismatches[model])

    def cone_holds(self):
        return self.median_ratio <= CONE_RATIO and self.iterations[CONE] <= CONE_ITERATIONS and not self.unsolved[CONE]

    def law_holds(self):
        within, steps = self.lawful(LAW)
        return within >= LAW_SHARE * steps and max(self.median_ratio, self.ratio_of_sums(LAW)) <= LAW_RATIO


def _cost(rows):
    """Of one table's line."""
    by_model = {}
    for row in rows:
        by_model.setdefault(row["friction"], {}).setdefault(int(row["step"]), []).append(row)
    t_s_ms = {model: [statistics.median(float(row["t_s_ms"]) for row in of_step) for of_step in by_step.values()]
              for model, by_step in by_model.items()}
    firsts = {model: [of_step[0] for of_step in by_step.values()] for model, by_step in by_model.items()}
    other, = (model for model in by_model if model != BOX)
    found = {model: [float(row["friction_mismatch"]) for row in of_model] for model, of_model in firsts.items()}
    return Cost(steps=len(firsts[BOX]), t_s_ms={model: statistics.fmean(times) for model, times in t_s_ms.items()},
                ratios=tuple(ms / box_ms for ms, box_ms in zip(t_s_ms[other], t_s_ms[BOX], strict=True)),
                iterations={model: max(int(row["iterations"]) for row in of_model) for model, of_model in firsts.items()},
                unsolved={model: sum(row["status"] != "ok" for row in of_model) for model, of_model in firsts.items()},
                mismatches={model: [value for value in values if not math.isnan(value)] for model, values in found.items()})


def _costs(rows, key, cold):
    found = {}
    for row in rows:
        if int(row["cold"]) == cold:
            found.setdefault(key(row), []).append(row)
    return {key: _cost(of_key) for key, of_key in found.items()}


def cone_costs(rows):
    """{(rocks, cfm): Cost}"""
    return _costs(rows, lambda row: (int(row["bodies"]), float(row["cfm"])), cold=1)


def law_costs(rows):
    """{scene: Cost}"""
    return _costs(rows, lambda row: row["scene"], cold=0)


def _verdict(holds):
    return "yes" if holds else "no"


def _share(within, steps):
    return f"{within} of {steps}, {math.floor(1000 * within / steps) / 10} %" if steps else "-"


def _cone_line(rocks, cfm, cost):
    return [rocks, text.power(cfm), cost.steps, *(text.number(cost.t_s_ms[model]) for model in (BOX, CONE)),
            f"{cost.median_ratio:.2f}", f"{max(cost.ratios):.2f}", *(cost.iterations[model] for model in (BOX, CONE)),
            *(cost.unsolved[model] for model in (BOX, CONE)), _verdict(cost.cone_holds())]


def _law_line(scene, cost):
    return [scene.replace("_", " "), cost.steps, *(text.number(cost.t_s_ms[model]) for model in (BOX, LAW)),
            f"{cost.ratio_of_sums(LAW):.2f}", f"{cost.median_ratio:.2f}",
            *(_share(*cost.lawful(model)) for model in (BOX, LAW)), *(cost.unsolved[model] for model in (BOX, LAW)),
            _verdict(cost.law_holds())]


CONE_HEADER = ("rocks", "cfm", "steps", "box, ms", "cone, ms", "cone / box, median", "most", "most iterations, box", "cone",
               "above the limit, box", "cone", "holds")
LAW_HEADER = ("scene", "steps", "box, ms", "Coulomb, ms", "Coulomb / box, of sums", "median",
              f"within {text.power(LAW_MISMATCH)} of the law, box", "Coulomb", "above the limit, box", "Coulomb", "holds")


def waited(rows):
    """Of a busy machine the times say less. No share: a wait that began before a solve counts whole."""
    waiting, total = (sum(float(row[column]) for row in rows) for column in ("t_s_waiting_ms", "t_s_ms"))
    return f"Threads waited {text.number(waiting)} ms for a core, in solves of {text.number(total)} ms."


def markdown(rows):
    """Two texts: cones and Coulomb's law, each with how many of its lines hold; of what was not measured there is none."""
    cones, laws = cone_costs(rows), law_costs(rows)
    if cones:
        yield (f"{sum(cost.cone_holds() for cost in cones.values())} of {len(cones)} hold: the cone takes at most {CONE_RATIO} "
               f"times as long as the box (median over the steps), at most {CONE_ITERATIONS} iterations, and leaves no step "
               "above the limit.\n\n" + text.table(CONE_HEADER, [_cone_line(*key, cost) for key, cost in cones.items()]))
    if laws:
        yield (f"{sum(cost.law_holds() for cost in laws.values())} of {len(laws)} hold: at least {text.percent(LAW_SHARE)} of "
               f"the steps are within {text.power(LAW_MISMATCH)} of Coulomb's law, at no more than {LAW_RATIO} times the time "
               "of the box, of sums and in the median.\n\n" +
               text.table(LAW_HEADER, [_law_line(scene, cost) for scene, cost in laws.items()]))
