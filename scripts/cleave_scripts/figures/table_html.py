"""Table 1 and the verdicts as HTML."""
import html
import itertools
import math
import re

from cleave_scripts.figures import looks, style
from cleave_scripts.figures.claim import HALF
from cleave_scripts.figures.verdicts import NOT_REPRODUCED, OPEN, REPRODUCED, WITHIN_NOISE
from cleave_scripts.results.command_line import counted
from cleave_scripts.results.verdict_rule import RULE
from cleave_scripts.table.cell_texts import CELL_HELP, GAP, WAITED, combinations, scene_notes

SIGNS = {
    REPRODUCED: ("yes", "✓"),
    NOT_REPRODUCED: ("no", "✗"),
    WITHIN_NOISE: ("noise", "≈"),
    OPEN: ("open", "○")
}

NUMBER = ' class="number"'


def rich(text):
    """Escaped text with t_s and t_pr as symbols, and gaps that stand out."""
    text = re.sub(r"(?<=\d) %", "\u00a0%", str(text))
    text = re.sub(r"\bt_(s|pr)\b", r"<i>t</i><sub>\1</sub>", html.escape(text))
    return re.sub(r"No data: [^.]*\.", r'<strong class="gap">\g<0></strong>', text)


def table1(tables):
    """Scene tables side by side: combinations down, and for every scene ours, the paper's and the ratio."""
    heads = "".join(
        f'<th colspan="3" class="group">{html.escape(table.title)}<small>'
        f'{counted(table.steps, "measured step")}, {counted(table.threads, "thread")}</small></th>'
        for table in tables)
    names = "".join('<th class="group">ours, ms</th><th>paper, ms</th><th>ratio</th>' for _ in tables)
    body = []
    previous = None
    for combination in combinations(tables):
        cells = "".join(_table1_cells(table, combination) for table in tables)
        css = ' class="first"' if combination[0] != previous else ""
        previous = combination[0]
        body.append(
            f"<tr{css}><th>{chip(combination[0])}{html.escape(' '.join(combination))}</th>{cells}</tr>")
    remarks = [
        f"{table.title}, {cell.partitioner} {cell.refiner}: {cell.remark}." for table in tables
        for cell in table.cells if cell.remark
    ] + scene_notes(tables)
    return (
        '<div class="wide"><table class="numbers"><thead>'
        f'<tr><td></td>{heads}</tr><tr><td></td>{names}</tr></thead>'
        f"<tbody>{''.join(body)}</tbody></table></div><p class=\"caption\">{rich(CELL_HELP)} Times are "
        f"written {rich('t_s + t_pr')}; marked: lowest total of a scene, among combinations without a failed "
        f"or missing "
        f"step. {html.escape(' '.join(remarks))}</p>")


def chip(partitioner):
    return f'<span class="chip" style="background:{looks.color(partitioner)}"></span>'


def _table1_cells(table, combination):
    cell = next((cell for cell in table.cells if (cell.partitioner, cell.refiner) == combination), None)
    if cell is None:
        return f'<td class="group">{GAP}</td><td>{GAP}</td><td>{GAP}</td>'
    ours = _pair(cell.ours, 3) + (' <span class="gap">!</span>' if cell.remark else "")
    ours += WAITED if cell.waited else ""
    return (f'<td class="group{" lowest" if cell.ours_lowest else ""}">{ours}</td>'
            f'<td{" class=lowest" if cell.paper_lowest else ""}>{_pair(cell.paper, 1)}</td>'
            f"<td>{_ratio((cell.ours / cell.paper)[2])}</td>")


def _ratio(value):
    return GAP if math.isnan(value) else f"{value:#.2g}"


def _pair(times, decimals):
    if math.isnan(times.total_ms):
        return '<span class="gap">no data</span>'
    most = 2 if decimals > 1 else 1
    t_s = f"{times.t_s_ms:.{0 if times.t_s_ms >= 1000 else 1 if times.t_s_ms >= 100 else most}f}"
    return f"{t_s} + {times.t_pr_ms:.{decimals}f}"


def verdict_table(verdicts):
    """The claims, each with its rows."""
    body = []
    for text, rows in itertools.groupby(verdicts, key=lambda item: item.claim.text):
        rows = list(rows)
        claim = f'<th rowspan="{len(rows)}" class="claim">{rich(text)}</th>'
        for index, item in enumerate(rows):
            css = ' class="first"' if index == 0 else ""
            body.append(f"<tr{css}>{claim if index == 0 else ''}{_verdict_cells(item)}</tr>")
    heads = "".join(f"<th{css}>{text}</th>" for text, css in (("claim of the paper", ""), ("where", ""),
                                                              ("verdict", ""), ("paper's table", NUMBER),
                                                              ("ours", NUMBER), ("wanted", NUMBER),
                                                              ("by Mflop", NUMBER), ("by interface rows",
                                                                                     NUMBER)))
    return (f'<div class="wide"><table class="verdicts"><thead><tr>{heads}</tr></thead>'
            f'<tbody>{"".join(body)}</tbody></table></div>'
            f'<p class="caption"><b>Rule.</b> {rich(RULE)} Below ours: the 95 % interval. † the paper\'s '
            "own table does not show what its text says.</p>")


def _verdict_cells(item):
    unit, (css, sign) = item.claim.unit, SIGNS[item.verdict]
    steps = f"{counted(item.steps, 'step')}, {counted(item.runs, 'run')}; " if item.steps else ""
    numbers = [
        figure_text(item.paper, unit) + (" †" if item.paper_disagrees else ""),
        f"{figure_text(item.ours, unit)}<small>{interval_text(item)}</small>",
        range_text(item),
        figure_text(item.mflop, unit),
        figure_text(item.interface_rows, unit)
    ]
    return (f"<td>{rich(item.claim.row)}<small>against {rich(item.claim.baseline)}</small></td>"
            f'<td><span class="badge {css}">{sign} {item.verdict}</span>'
            f'<small>{rich(steps + item.reason)}</small></td>' +
            "".join(f"<td{NUMBER}>{text}</td>" for text in numbers))


def figure_text(value, unit):
    if math.isnan(value):
        return GAP
    text = {
        "%": f"{100 * value:.{0 if abs(value) >= 1 or value == 0 else 1}f} %",
        "x": f"{style.short(value)}×"
    }.get(unit, f"{value:.2f}")
    return text.replace("-", "−")


def interval_text(item):
    if math.isnan(item.low) or item.low == item.high:
        return ""
    return f"{figure_text(item.low, item.claim.unit)} to {figure_text(item.high, item.claim.unit)}"


def range_text(item):
    unit, most = item.claim.unit, item.claim.most
    if not math.isinf(most):
        return f"{figure_text(item.least, unit)} to {figure_text(most, unit)}"
    half = "<small>half the paper's</small>" if item.claim.share_of_paper == HALF else ""
    return f"≥ {figure_text(item.least, unit)}{half}"
