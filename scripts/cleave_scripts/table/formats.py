"""Table 1 as text, CSV, Markdown and LaTeX: each function takes scene tables and lines that explain them."""
import csv
import io
import math
import textwrap

from cleave_scripts.results.command_line import counted
from cleave_scripts.table import text
from cleave_scripts.table.cell_texts import (CELL_HELP, WAITED, across, format_number, format_ratio, pair,
                                             scene_notes)
from cleave_scripts.table.latex import format_latex

MARK_HELP = "* lowest t_s + t_pr of a scene among combinations without a failed or missing step."


def format_text(tables, header):
    lines = ["Table 1: mean ms a step; t_s solve, t_pr partition + refine", *header, MARK_HELP]
    for table in tables:
        steps, threads = counted(table.steps, "measured step"), counted(table.threads, "thread")
        widths = _name_widths(table.cells)
        margin = " " * sum(widths)
        times, ratios = f"{'t_s':>9}{'t_pr':>9}{'total':>10}  |", f"{'t_s':>8}{'t_pr':>8}{'total':>8}  |"
        lines += ["", f"{table.title}: {steps}, solver {table.solver}, {threads}"]
        lines.append(f"{margin}|{'ours, ms':^29} |{'paper, ms':^29} |{'ours / paper':^25} |")
        lines.append(f"{margin}|{times}{times}{ratios}")
        lines += [_text_row(cell, *widths) for cell in table.cells]
        lines += _remarks(table.cells)
        lines += _wrapped(scene_notes([table]))
    return "\n".join(lines) + "\n"


def _remarks(cells):
    """One line for all combinations of which the same is to be said."""
    names = {}
    for cell in cells:
        if cell.remark:
            names.setdefault(cell.remark, []).append(f"{cell.partitioner} {cell.refiner}")
    return _wrapped(f"! {remark}: {', '.join(combinations)}" for remark, combinations in names.items())


def _wrapped(texts):
    return [line for text in texts for line in textwrap.wrap(text, 105, subsequent_indent="  ")]


def _name_widths(cells):
    """Of the columns of partitioners and refiners."""
    return [max(7, 1 + max(len(getattr(cell, name)) for cell in cells)) for name in ("partitioner", "refiner")]


def _text_row(cell, partitioner_width, refiner_width):
    ratios = "".join(f"{format_ratio(ratio):>8}" for ratio in cell.ours / cell.paper)
    return (f"{cell.partitioner:<{partitioner_width}}{cell.refiner:<{refiner_width}}|" +
            _text_times(cell.ours, cell.ours_lowest, 3) + _text_times(cell.paper, cell.paper_lowest, 1) + f"{ratios}  |" +
            ("!" if cell.remark else "") + _waited(cell))


def _waited(cell):
    return WAITED if cell.waited else ""


def _text_times(times, lowest, decimals):
    return (f"{format_number(times.t_s_ms, decimals):>9}{format_number(times.t_pr_ms, decimals):>9}"
            f"{format_number(times.total_ms, decimals):>10}{'*' if lowest else ' '} |")


def format_csv(tables, header):
    """One line a cell; empty where a value is missing. The explanation goes to comment lines."""
    out = io.StringIO()
    out.writelines(f"# {line}\n" for line in [*header, *scene_notes(tables)])
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow([
        "scene", "partitioner", "refiner", "t_s_ms", "t_pr_ms", "total_ms", "paper_t_s_ms", "paper_t_pr_ms",
        "paper_total_ms", "ratio_t_s", "ratio_t_pr", "ratio_total", "lowest", "paper_lowest", "steps_ok",
        "steps_failed", "steps_missing", "waiting_share"
    ])
    for table in tables:
        for cell in table.cells:
            numbers = [
                cell.ours.t_s_ms, cell.ours.t_pr_ms, cell.ours.total_ms, cell.paper.t_s_ms,
                cell.paper.t_pr_ms, cell.paper.total_ms, *(cell.ours / cell.paper)
            ]
            writer.writerow([
                table.scene, cell.partitioner, cell.refiner,
                *("" if math.isnan(value) else f"{value:.6g}" for value in numbers),
                int(cell.ours_lowest),
                int(cell.paper_lowest), cell.ok, cell.failed, cell.missing,
                "" if math.isnan(cell.waiting) else f"{cell.waiting:.3g}"
            ])
    return out.getvalue()


def format_markdown(tables, header):
    """Combinations down, scenes across: ours t_s + t_pr (paper's) and the ratio; the lowest total in bold."""
    lines = []
    for cells in across(tables):
        entries = []
        for cell in cells:
            ours = pair(cell.ours, 2, 3) + _waited(cell) + (f" ({cell.remark})" if cell.remark else "")
            paper = pair(cell.paper, 1, 1)
            entries.append(f"{_bold(ours, cell.ours_lowest)} (paper {_bold(paper, cell.paper_lowest)}), "
                           f"×{format_ratio((cell.ours / cell.paper)[2])}")
        lines.append([f"{cells[0].partitioner} {cells[0].refiner}", *entries])
    titles = [f"{table.title}, {counted(table.steps, 'step')}" for table in tables]
    help_line = CELL_HELP + " Bold: lowest total of the scene."
    return "\n".join([text.table(["", *titles], lines), "", help_line, *header, *scene_notes(tables)]) + "\n"


def _bold(text, bold):
    return f"**{text}**" if bold else text


FORMATS = {"text": format_text, "csv": format_csv, "markdown": format_markdown, "latex": format_latex}
