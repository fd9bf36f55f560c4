"""Judges the paper's claims by the rule in verdict_rule.py."""
import dataclasses
import math

import pandas

from cleave_scripts.figures.claim_values import noise, tables, value
from cleave_scripts.figures.choose import same_setup_with
from cleave_scripts.figures.claims import KARGER_RIVALS, LONGEST_LOG_TOWER, ROCKS, all_claims, karger_place
from cleave_scripts.figures.times_by_size import sizes
from cleave_scripts.figures.times_by_step import longest_runs
from cleave_scripts.figures.tree import NoData
from cleave_scripts.results.paper import SCENES

FEWEST_STEPS = 5  # fewer measured steps tell nothing about noise
REPRODUCED, NOT_REPRODUCED, WITHIN_NOISE, OPEN = "reproduced", "not reproduced", "within noise", "open"


@dataclasses.dataclass
class Verdict:
    """One judged row; figures are nan where there is none."""

    claim: object
    verdict: str
    paper: float = math.nan
    ours: float = math.nan
    low: float = math.nan
    high: float = math.nan
    mflop: float = math.nan
    interface_rows: float = math.nan
    steps: int = 0
    runs: int = 0
    reason: str = ""
    least: float = 0.0

    @property
    def paper_disagrees(self):
        """The paper's own table does not show what its text says."""
        return self.paper < self.claim.least or self.paper > self.claim.most


def judge_all(data, paper):
    """One Verdict a row of the claims."""
    places = dict(data.main)
    try:
        rock_sizes = sizes(data.blocks, data.solver)
    except NoData:
        rock_sizes = {}
    places |= {f"{ROCKS} {size}": group for size, group in rock_sizes.items()}
    try:
        places[LONGEST_LOG_TOWER] = longest_runs(data)
    except NoData:
        pass  # its claims stay open
    for scene in SCENES:
        if found := same_setup_with(data.blocks, scene, data.solver, ("karger", *KARGER_RIVALS)):
            places[karger_place(scene)] = found
    columns = {column for group in data.main.values() for part in group for column in part.rows.columns}
    return [judge(claim, places, paper) for claim in all_claims(paper, list(rock_sizes), columns)]


def judge(claim, places, paper):
    verdict = Verdict(claim, OPEN, least=claim.least)
    if claim.paper_cells:
        verdict.paper = float(claim.figure(lambda cell: paper[cell][0]))
        if claim.share_of_paper:
            verdict.least = max(claim.least, claim.share_of_paper * verdict.paper)
    try:
        if not claim.cells:
            raise NoData("no runs of different sizes")
        _measure(verdict, places)
    except NoData as gap:
        verdict.reason = f"no data: {gap}"
        return verdict
    _decide(verdict)
    return verdict


def _measure(verdict, places):
    claim = verdict.claim
    measured = _runs(claim, places, claim.column)
    verdict.steps, verdict.runs = min(len(table) for table in measured[0].values()), len(measured)
    verdict.ours = verdict.low = verdict.high = value(claim, measured[0])
    if claim.statistic != "most":
        _set_interval(verdict, places, measured)
    if claim.sizes_decide:
        verdict.mflop, verdict.interface_rows = (
            _counted(claim, places, column) for column in ("factor_mflop", "interface_rows"))


def _runs(claim, places, column):
    """The tables of every run that has all cells; NoData where the one that the figures show has not."""
    found = [tables(claim, places, column, 0)]
    for run in range(1, min(len(places[cell[0]]) for cell in claim.cells)):
        try:
            found.append(tables(claim, places, column, run))
        except NoData:
            pass  # a repeat that stopped early or lacks the column has nothing to say about noise
    return found


def _set_interval(verdict, places, measured):
    verdict.low = verdict.high = math.nan
    if verdict.claim.column == "t_s_ms":
        try:
            measured = measured + _runs(verdict.claim, places, "t_s_min_ms")
        except NoData:
            pass  # then t_s_ms stands alone
    long_enough = [found for found in measured if min(map(len, found.values())) >= FEWEST_STEPS]
    if verdict.steps >= FEWEST_STEPS:
        ends = [noise(verdict.claim, found) for found in long_enough]
        verdict.low, verdict.high = min(low for low, _ in ends), max(high for _, high in ends)


def _counted(claim, places, column):
    try:
        return value(claim, tables(claim, places, column, 0))
    except NoData:
        return math.nan


def _decide(verdict):
    least, most, column = verdict.least, verdict.claim.most, verdict.claim.column
    measured = "by time" if column.startswith("t_") else f"by {column}"
    if verdict.low >= least and verdict.high <= most:
        verdict.verdict, verdict.reason = REPRODUCED, measured
    elif verdict.high < least or verdict.low > most:
        verdict.verdict, verdict.reason = NOT_REPRODUCED, measured
    else:
        verdict.verdict, verdict.reason = _by_sizes(verdict, least, most)


def _by_sizes(verdict, least, most):
    """(verdict, reason) from the counted columns."""
    if not verdict.claim.sizes_decide or math.isnan(verdict.mflop) or math.isnan(verdict.interface_rows):
        return WITHIN_NOISE, "time cannot tell, and no counted column decides"
    by_mflop, by_rows = least <= verdict.mflop <= most, least <= verdict.interface_rows <= most
    if math.isinf(most):  # a gain: counted columns are exact, so that 0 is no gain
        by_mflop, by_rows = by_mflop and verdict.mflop > 0, verdict.interface_rows > 0
        if verdict.mflop == verdict.interface_rows == 0:
            return WITHIN_NOISE, "time cannot tell, and Mflop and interface rows are the same"
    if by_mflop == by_rows:
        return REPRODUCED if by_mflop else NOT_REPRODUCED, "by Mflop and interface rows"
    if verdict.claim.share_of_paper and not by_mflop:
        return NOT_REPRODUCED, "time cannot tell; by Mflop the gain is too small"
    return WITHIN_NOISE, "time cannot tell, Mflop and interface rows disagree"


def as_frame(verdicts):
    """For verdicts.csv."""
    return pandas.DataFrame([{
        "claim": item.claim.text,
        "row": item.claim.row,
        "baseline": item.claim.baseline,
        "column": item.claim.column,
        "statistic": item.claim.statistic,
        "least": item.least,
        "most": item.claim.most,
        "paper_table": item.paper,
        "ours": item.ours,
        "low": item.low,
        "high": item.high,
        "mflop": item.mflop,
        "interface_rows": item.interface_rows,
        "steps": item.steps,
        "runs": item.runs,
        "verdict": item.verdict,
        "reason": item.reason
    } for item in verdicts])
