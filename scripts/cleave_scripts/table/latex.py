"""Table 1 as LaTeX."""
from cleave_scripts.table.cell_texts import CELL_HELP, WAITED, across, format_ratio, pair, scene_notes


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
    for cells in across(tables):
        entries = [_latex(f"{cells[0].partitioner} {cells[0].refiner}")]
        for cell in cells:
            ours, paper = pair(cell.ours, 2, 3), pair(cell.paper, 1, 1)
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
