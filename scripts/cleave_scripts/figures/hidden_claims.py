"""Which claim of the paper holds under which of the choices it leaves open (measurements/hidden_choices.py)."""
import math
import types

import numpy
import pandas

from cleave_scripts.figures.claims import all_claims
from cleave_scripts.figures.tree import NoData
from cleave_scripts.figures.verdicts import NOT_REPRODUCED, REPRODUCED, judge
from cleave_scripts.measurements.hidden_choices import CUT, MOST, TIME, cells_of
from cleave_scripts.results.paper import COMBINATIONS, PAPER, SCENES

OTHER_STATISTIC = "most"  # of claims about the worst part of all steps


def judged_claims(paper):
    """Those of the claims that are about the cells of Table 1 and not about the time of partitioning."""
    return [claim for claim in all_claims(paper, [], set(MOST)) if claim.cells and not claim.column.startswith("t_pr") and
            {cell[0] for cell in claim.cells} <= set(SCENES)]


def outcome_by_cut(claim, found, setting):
    """Of a gain: whether there are fewer interface rows; how large a gain in time is, they do not say.
    Where nothing is cut, they say nothing."""
    by_own_column = claim.statistic == OTHER_STATISTIC

    def value(cell):
        return numpy.float64(getattr(found.row(setting, cell, CUT), claim.column) if by_own_column else
                             found.value(setting, cell, CUT))

    with numpy.errstate(divide="ignore", invalid="ignore"):
        figure = float(claim.figure(value))
    if math.isnan(figure):
        return "cannot_tell"
    holds = claim.least <= figure <= claim.most if by_own_column else figure > 0
    return "holds" if holds else "fails"


def verdict_by_time(claim, rows, setting, paper):
    """As of every other run: with the noise of its steps."""
    places = {}
    for scene, cells in cells_of(rows, setting, PAPER["solver"]).items():
        names = {setting.name_of(name): name for name in dict.fromkeys(name for name, _ in COMBINATIONS)}
        chosen = cells[cells["partitioner"].isin(names)]
        places[scene] = [types.SimpleNamespace(ok=chosen.assign(partitioner=chosen["partitioner"].map(names)))]
    try:
        return judge(claim, places, paper).verdict
    except NoData:
        return None


def claim_rows(found, rows, paper, told=lambda done, of: None):
    """A row a part of a claim, n_max and order of bodies: in how many of their settings it holds."""
    claims, table = judged_claims(paper), []
    for by, which in ((CUT, found.all), (TIME, found.timed)):
        for number, claim in enumerate(claims, 1):
            if by == TIME and claim.statistic == OTHER_STATISTIC:
                continue  # is not about time
            told(number, len(claims))
            groups = {}
            for setting in which:
                counts = groups.setdefault((setting.max_bodies, setting.order), {"holds": 0, "fails": 0, "cannot_tell": 0})
                counts[_outcome(claim, found, rows, setting, by, paper)] += 1
            table += [{"claim": claim.text, "row": claim.row, "by": by, "max_bodies": size, "order": order, **counts}
                      for (size, order), counts in groups.items()]
    return pandas.DataFrame(table)


def _outcome(claim, found, rows, setting, by, paper):
    if by == CUT:
        return outcome_by_cut(claim, found, setting)
    return {REPRODUCED: "holds", NOT_REPRODUCED: "fails"}.get(verdict_by_time(claim, rows, setting, paper), "cannot_tell")
