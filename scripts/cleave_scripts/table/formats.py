"""Table 1 as text, CSV, Markdown and LaTeX: each function takes scene tables and lines that explain them."""
import csv
import io
import math
import textwrap

from cleave_scripts.results.command_line import counted
from cleave_scripts.table.timing_table import MOST_WAITING, Cell

GAP = "-"
MARK_HELP = "* lowest t_s + t_pr of a scene among combinations without a failed or missing step."
WAITED = "‡"
CELL_HELP = "t_s solve, t_pr partition + refine, mean ms a step; ratio = ours / paper of t_s + t_pr."


def format_number(value, decimals=2):
    return GAP if math.isnan(value) else f"{value:.{decimals}f}"


def format_ratio(value):
    return GAP if math.isnan(value) else f"{value:#.3g}"


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


def scene_notes(tables):
    """What has to be known before comparing: runs of another size than the paper's, and disturbed ones."""
    notes = [
        f"{table.title} is not the paper's run: {table.differs}; its ratios compare different problems."
        for table in tables if table.differs
    ]
    waited = [
        f"{table.title} {cell.partitioner} {cell.refiner} {100 * cell.waiting:.0f} %" for table in tables
        for cell in table.cells if cell.waited
    ]
    if waited:
        notes.append(f"{WAITED} The solves waited more than {100 * MOST_WAITING:.0f} % of t_s for a core, so "
                     f"other programs are in these times: {', '.join(waited)}.")
    return notes


def _name_widths(cells):
    """Of the columns of partitioners and refiners."""
    return [max(7, 1 + max(len(getattr(cell, name)) for cell in cells)) for name in ("partitioner", "refiner")]


def _text_row(cell, partitioner_width, refiner_width):
    ratios = "".join(f"{format_ratio(ratio):>8}" for ratio in cell.ours / cell.paper)
    return (f"{cell.partitioner:<{partitioner_width}}{cell.refiner:<{refiner_width}}|" + _text_times(cell.ours, cell.ours_lowest, 3) +
            _text_times(cell.paper, cell.paper_lowest, 1) + f"{ratios}  |" + ("!" if cell.remark else "") +
            _waited(cell))


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
    lines = [
        "| | " + " | ".join(f"{table.title}, {counted(table.steps, 'step')}" for table in tables) + " |",
        "|---|" + "---|" * len(tables)
    ]
    for cells in _across(tables):
        entries = []
        for cell in cells:
            ours = _pair(cell.ours, 2, 3) + _waited(cell) + (f" ({cell.remark})" if cell.remark else "")
            paper = _pair(cell.paper, 1, 1)
            entries.append(f"{_bold(ours, cell.ours_lowest)} (paper {_bold(paper, cell.paper_lowest)}), "
                           f"×{format_ratio((cell.ours / cell.paper)[2])}")
        lines.append(f"| {cells[0].partitioner} {cells[0].refiner} | " + " | ".join(entries) + " |")
    help_line = CELL_HELP + " Bold: lowest total of the scene."
    return "\n".join([*lines, "", help_line, *header, *scene_notes(tables)]) + "\n"


def _bold(text, bold):
    return f"**{text}**" if bold else text


def _pair(times, t_s_decimals, t_pr_decimals):
    if math.isnan(times.total_ms):
        return GAP
    return f"{times.t_s_ms:.{t_s_decimals}f} + {times.t_pr_ms:.{t_pr_decimals}f}"


def format_latex(tables, header):
    """A booktabs table* in the order of the Markdown one; needs \\usepackage{booktabs}."""
    groups = "".join(" & \\multicolumn{3}{c}{" + _latex(table.title) + "}" for table in tables)
    rules = "".join(f"\\cmidrule(lr){{{3 * index + 2}-{3 * index + 4}}}" for index in range(len(tables)))
    lines = [
        "% needs \\usepackage{booktabs}", "\\begin{table*}", "\\centering\\footnotesize",
        "\\begin{tabular}{l" + "rrr" * len(tables) + "}", "\\toprule",
        groups.lstrip() + " \\\\", rules, "combination" + " & ours & paper & ratio" * len(tables) + " \\\\",
        "\\midrule"
    ]
    for cells in _across(tables):
        entries = [_latex(f"{cells[0].partitioner} {cells[0].refiner}")]
        for cell in cells:
            ours, paper = _pair(cell.ours, 2, 3), _pair(cell.paper, 1, 1)
            entries += [
                _latex_bold(ours, cell.ours_lowest) + ("$^\\dagger$" if cell.remark else "") +
                ("$^\\ddagger$" if cell.waited else ""),
                _latex_bold(paper, cell.paper_lowest),
                format_ratio((cell.ours / cell.paper)[2])
            ]
        lines.append(" & ".join(entries) + " \\\\")
    remarks = ["$^\\dagger$ steps failed or missing, not in the mean."] if any(
        cell.remark for table in tables for cell in table.cells) else []
    cell_help = CELL_HELP.replace("t_s", "$t_s$").replace("t_pr", "$t_{pr}$")
    caption = " ".join([cell_help, *map(_latex, [*header, *scene_notes(tables)]), *remarks])
    lines += ["\\bottomrule", "\\end{tabular}", "\\caption{" + caption + "}", "\\end{table*}"]
    return "\n".join(lines) + "\n"


def _latex(text):
    text = "".join("\\" + letter if letter in "_%#&$" else letter for letter in text)
    return text.replace(WAITED, "$^\\ddagger$")


def _latex_bold(text, bold):
    return f"\\textbf{{{text}}}" if bold else text


def combinations(tables):
    """All combinations of the tables; one that only some have stands beside its partitioner's others."""
    names = dict.fromkeys((cell.partitioner, cell.refiner) for table in tables for cell in table.cells)
    partitioners = list(dict.fromkeys(partitioner for partitioner, _ in names))
    return sorted(names, key=lambda name: partitioners.index(name[0]))


def _across(tables):
    """For every combination its cells, one a scene."""
    names = combinations(tables)
    by_table = [{(cell.partitioner, cell.refiner): cell for cell in table.cells} for table in tables]
    return [[cells.get(name) or Cell(*name) for cells in by_table] for name in names]


FORMATS = {"text": format_text, "csv": format_csv, "markdown": format_markdown, "latex": format_latex}
