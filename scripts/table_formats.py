"""Table 1 as text, CSV, Markdown and LaTeX: each function takes scene tables and lines that explain them."""
import csv
import io
import math
import textwrap

from cleave_results import counted
from timing_table import Cell

GAP = "-"
MARK_HELP = "* lowest t_s + t_pr of a scene among combinations without a failed or missing step."
CELL_HELP = "t_s solve, t_pr partition + refine, mean ms a step; ratio = ours / paper of t_s + t_pr."


def format_number(value, decimals=2):
    return GAP if math.isnan(value) else f"{value:.{decimals}f}"


def format_ratio(value):
    return GAP if math.isnan(value) else f"{value:#.3g}"


def format_text(tables, header):
    lines = ["Table 1: mean ms a step; t_s solve, t_pr partition + refine", *header, MARK_HELP]
    for table in tables:
        steps, threads = counted(table.steps, "measured step"), counted(table.threads, "thread")
        times, ratios = f"{'t_s':>9}{'t_pr':>9}{'total':>10}  |", f"{'t_s':>8}{'t_pr':>8}{'total':>8}  |"
        lines += ["", f"{table.title}: {steps}, solver {table.solver}, {threads}"]
        lines.append(f"{'':14}|{'ours, ms':^29} |{'paper, ms':^29} |{'ours / paper':^25} |")
        lines.append(f"{'':14}|{times}{times}{ratios}")
        lines += [_text_row(cell) for cell in table.cells]
        lines += _remarks(table.cells)
    return "\n".join(lines) + "\n"


def _remarks(cells):
    """One line for all combinations of which the same is to be said."""
    names = {}
    for cell in cells:
        if cell.remark:
            names.setdefault(cell.remark, []).append(f"{cell.partitioner} {cell.refiner}")
    texts = [f"! {remark}: {', '.join(combinations)}" for remark, combinations in names.items()]
    return [line for text in texts for line in textwrap.wrap(text, 105, subsequent_indent="  ")]


def _text_row(cell):
    ratios = "".join(f"{format_ratio(ratio):>8}" for ratio in cell.ours / cell.paper)
    return (f"{cell.partitioner:<7}{cell.refiner:<7}|" + _text_times(cell.ours, cell.ours_lowest, 3) +
            _text_times(cell.paper, cell.paper_lowest, 1) + f"{ratios}  |{'!' if cell.remark else ''}")


def _text_times(times, lowest, decimals):
    return (f"{format_number(times.t_s_ms, decimals):>9}{format_number(times.t_pr_ms, decimals):>9}"
            f"{format_number(times.total_ms, decimals):>10}{'*' if lowest else ' '} |")


def format_csv(tables, header):
    """One line a cell; empty where a value is missing. The explanation goes to comment lines."""
    out = io.StringIO()
    out.writelines(f"# {line}\n" for line in header)
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow([
        "scene", "partitioner", "refiner", "t_s_ms", "t_pr_ms", "total_ms", "paper_t_s_ms", "paper_t_pr_ms",
        "paper_total_ms", "ratio_t_s", "ratio_t_pr", "ratio_total", "lowest", "paper_lowest", "steps_ok",
        "steps_failed", "steps_missing"
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
                int(cell.paper_lowest), cell.ok, cell.failed, cell.missing
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
            ours = _pair(cell.ours, 2, 3) + (f" ({cell.remark})" if cell.remark else "")
            paper = _pair(cell.paper, 1, 1)
            entries.append(f"{_bold(ours, cell.ours_lowest)} (paper {_bold(paper, cell.paper_lowest)}), "
                           f"×{format_ratio((cell.ours / cell.paper)[2])}")
        lines.append(f"| {cells[0].partitioner} {cells[0].refiner} | " + " | ".join(entries) + " |")
    return "\n".join([*lines, "", CELL_HELP + " Bold: lowest total of the scene.", *header]) + "\n"


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
        entries = [f"{cells[0].partitioner} {cells[0].refiner}"]
        for cell in cells:
            ours, paper = _pair(cell.ours, 2, 3), _pair(cell.paper, 1, 1)
            entries += [
                _latex_bold(ours, cell.ours_lowest) + ("$^\\dagger$" if cell.remark else ""),
                _latex_bold(paper, cell.paper_lowest),
                format_ratio((cell.ours / cell.paper)[2])
            ]
        lines.append(" & ".join(entries) + " \\\\")
    remarks = ["$^\\dagger$ steps failed or missing, not in the mean."] if any(
        cell.remark for table in tables for cell in table.cells) else []
    caption = " ".join(
        [CELL_HELP.replace("t_s", "$t_s$").replace("t_pr", "$t_{pr}$"), *map(_latex, header), *remarks])
    lines += ["\\bottomrule", "\\end{tabular}", "\\caption{" + caption + "}", "\\end{table*}"]
    return "\n".join(lines) + "\n"


def _latex(text):
    return "".join("\\" + letter if letter in "_%#&$" else letter for letter in text)


def _latex_bold(text, bold):
    return f"\\textbf{{{text}}}" if bold else text


def _across(tables):
    """For every combination its cells, one a scene."""
    names = list(dict.fromkeys((cell.partitioner, cell.refiner) for table in tables for cell in table.cells))
    by_table = [{(cell.partitioner, cell.refiner): cell for cell in table.cells} for table in tables]
    return [[cells.get(name) or Cell(*name) for cells in by_table] for name in names]


FORMATS = {"text": format_text, "csv": format_csv, "markdown": format_markdown, "latex": format_latex}
