"""Table 1 and the verdicts: their numbers, files and HTML."""
import dataclasses
import html

import pandas

from cleave_scripts.figures import page, style
from cleave_scripts.figures.choose import merged_runs
from cleave_scripts.figures.table_html import chip, table1, verdict_table
from cleave_scripts.figures.tree import NoData
from cleave_scripts.figures.verdicts import as_frame
from cleave_scripts.results.about import setup_columns
from cleave_scripts.results.errors import ResultError
from cleave_scripts.results.manifest import machine
from cleave_scripts.results.names import title
from cleave_scripts.results.paper import load_paper_table1
from cleave_scripts.results.steps import Row
from cleave_scripts.results.whole_file import write_text
from cleave_scripts.table.formats import FORMATS
from cleave_scripts.table.timing_table import build_tables

FILES = {
    "csv": ("CSV", "table1.csv", "text/csv"),
    "markdown": ("Markdown", "table1.md", "text/markdown"),
    "latex": ("LaTeX", "table1.tex", "application/x-tex")
}
NEEDED = ("seed", "threads", "t_s_ms", "t_pr_ms")


def scene_tables(data):
    """(scene tables, faults): a scene that cannot be averaged becomes a line; the others stay."""
    tables, faults = [], []
    for scene, group in data.main.items():
        rows = _rows(group)
        absent = [column for column in NEEDED if column not in rows[0]]
        try:
            if absent:
                raise NoData(f"column {', '.join(absent)} is missing")
            setup = setup_columns(*(block.experiment.manifest for block in group))
            tables += build_tables(rows, load_paper_table1(), setup=setup)
        except (NoData, ResultError) as reason:
            faults.append(f"{title(scene)}, {reason}")
    return tables, faults


def _rows(group):
    """The rows of a scene as Table 1 wants them: where a run was repeated, with the medians of its times, as in the figures."""
    written = [[block.experiment.table_rows[index] for index in block.rows.index] for block in group]
    merged = merged_runs([dataclasses.replace(block, rows=block.rows.assign(written=rows))
                          for block, rows in zip(group, written)])
    return [_row(row) for _, row in merged.iterrows()]


def _row(merged):
    times = {name: repr(float(merged[name])) for name in merged["written"]
             if name.endswith("_ms") and pandas.notna(merged[name])}
    return Row(merged["written"] | times, merged["written"].path, merged["written"].line)


def table1_body(data, tables, faults, directory):
    """HTML with links to save the table in every format, which also go to the directory."""
    for _, name, _ in FILES.values():
        (directory / name).unlink(missing_ok=True)
    if not tables:
        raise NoData("; ".join(faults) or f"no rows of solver {data.solver}")
    machines = sorted({machine(part.experiment.manifest) for group in data.main.values() for part in group})
    links = []
    for kind, (label, name, media_type) in FILES.items():
        text = FORMATS[kind](tables, [f"Ours: {name}." for name in machines])
        write_text(directory / name, text)
        links.append(page.download(label, directory / name, media_type))
    gaps = "".join(map(page.gap, faults))
    return f'{table1(tables)}{gaps}<p class="caption links">{" · ".join(links)}</p>'


def verdicts_body(verdicts, directory):
    path = directory / "verdicts.csv"
    write_text(path, as_frame(verdicts).to_csv(index=False))
    link = page.download("CSV", path, "text/csv")
    return f'{verdict_table(verdicts)}<p class="caption links">{link}</p>'


def lowest_totals(tables):
    """Which combination wins each scene, here and in the paper."""

    def winner(table, which):
        names = [
            f"{chip(cell.partitioner)}{html.escape(cell.partitioner)} {html.escape(cell.refiner)}, "
            f"{style.short(getattr(cell, which).total_ms)} ms"
            for cell in table.cells
            if getattr(cell, which + "_lowest")
        ]
        return "; ".join(names) or "–"

    rows = [
        f""
        f"<tr><td>{html.escape(table.title)}</td><td>{winner(table, 'ours')}</td>"
        f"<td>{winner(table, 'paper')}</td></tr>" for table in tables
    ]
    head = "<tr><th>lowest mean total a step</th><th>here</th><th>in the paper</th></tr>"
    if not rows:
        return ""
    return f'<div class="wide"><table><thead>{head}</thead><tbody>{"".join(rows)}</tbody></table></div>'
