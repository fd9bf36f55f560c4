"""What scripts/ablate_interior_point measured: totals by constant and value, and the tables of them."""
import csv
import dataclasses
import io
import re

from cleave_scripts.results.programs import ROOT
from cleave_scripts.table import text

NOTHING = 0.01  # a constant that changes the factorisations by less than this share, and loses no problem, buys nothing


@dataclasses.dataclass
class Total:
    """One constant at one value, over all problems."""
    constant: str
    value: str
    kind: str  # default, off or other
    problems: int = 0
    factorizations: int = 0
    most: int = 0  # factorisations of one problem
    proximal: int = 0  # problems that the first attempt left above the limit
    above_limit: int = 0
    worst_m_per_s: float = 0.0

    def add(self, row):
        count = int(row["factorizations"])
        self.problems += 1
        self.factorizations += count
        self.most = max(self.most, count)
        self.proximal += row["proximal"] == "1"
        self.above_limit += row["exact"] != "1"
        self.worst_m_per_s = max(self.worst_m_per_s, float(row["residual_m_per_s"]))

    def ratio(self, default):
        return self.factorizations / default.factorizations

    def is_worse(self, default):
        return self.above_limit > default.above_limit or self.ratio(default) >= 1 + NOTHING


def names():
    """Of the constants, as the solver has them."""
    header = ROOT / "solver" / "strategies" / "interior_constants.h"
    return re.findall(r"^  (?:double|int) (\w+) = ", header.read_text(encoding="utf-8"), re.M)


def totals(text):
    """Of the CSV that interior_point_benchmark writes, in its order: the default comes first."""
    found = {}
    for row in csv.DictReader(io.StringIO(text)):
        key = (row["constant"], row["value"], row["kind"])
        found.setdefault(key, Total(*key)).add(row)
    return list(found.values())


def by_constant(found):
    """(the default, {constant: totals})"""
    default, *changed = found
    constants = {}
    for total in changed:
        constants.setdefault(total.constant, []).append(total)
    return default, constants


def buying_nothing(found):
    """Constants without which the solver is as good: where nothing takes them away, at every value that was tried."""
    default, constants = by_constant(found)
    names = []
    for name, values in constants.items():
        judged = [total for total in values if total.kind == "off"] or values
        if not any(total.is_worse(default) for total in judged):
            names.append(name)
    return names


def _cell(total, default):
    text = f"off ({total.value})" if total.kind == "off" else total.value
    text += f": {total.factorizations} ({total.ratio(default):.3f})"
    for name, of_default, count in (("proximal", default.proximal, total.proximal),
                                    ("above the limit", default.above_limit, total.above_limit)):
        text += f", {count} {name}" if count != of_default else ""
    return text


def markdown(found):
    default, constants = by_constant(found)
    lines = [f"As it is: {default.factorizations} factorisations over {default.problems} problems, at most {default.most} "
             f"of one; {default.proximal} proximal, {default.above_limit} above the limit, worst residual "
             f"{default.worst_m_per_s:.1e} m/s. Proximal: the first attempt ended above the limit, and proximal steps "
             "followed; shown where the number differs.", "",
             text.table(["constant", "value tried: factorisations (over those as it is)"],
                        [[f"`{name}`", "; ".join(_cell(total, default) for total in values)]
                         for name, values in constants.items()])]
    nothing = ", ".join(f"`{name}`" for name in buying_nothing(found)) or "none"
    return "\n".join([*lines, "",
                      f"Buys nothing here (less than {NOTHING:g} of the factorisations, and no problem): {nothing}."])
