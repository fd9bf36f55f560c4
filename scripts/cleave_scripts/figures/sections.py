"""The sections of the report, in its order."""
import html

from cleave_scripts.figures import page, style
from cleave_scripts.figures.registry import FIGURES
from cleave_scripts.figures.runs import runs_body
from cleave_scripts.figures.table_html import SIGNS
from cleave_scripts.figures.tables import lowest_totals, scene_tables, table1_body, verdicts_body
from cleave_scripts.figures.tree import NoData
from cleave_scripts.figures.verdicts import judge_all
from cleave_scripts.results.errors import ResultError
from cleave_scripts.results.paper import load_paper_table1
from cleave_scripts.viewer.page import NO_MOTION, viewer_section

PAPER, BEYOND, RUNS = "The paper", "Beyond the paper", "The runs"
RENDERED = ((
    "figure1", "Figure 1: the scenes and their constraint graphs",
    "Bodies of Chain Drop, Rock Pile and Log Tower with the graph over them: nodes blue, edges red."),
            ("figure2", "Figure 2: one frame of Rock Pile, split by every combination",
             "Bodies coloured by part, edges between parts drawn; partitioners across, refiners down."))


def build(data, directory):
    """(sections, gaps): files go to directory/figures; gaps are (anchor, heading, reason)."""
    files = directory / "figures"
    gaps = []
    tables, faults = scene_tables(data)
    verdicts = judge_all(data, load_paper_table1())
    sections = [_rendered(files, *entry, gaps) for entry in RENDERED]
    sections += [_figure(data, files, figure, PAPER, gaps) for figure in FIGURES if figure.paper]
    sections += [
        _with_gap("table1", "Table 1: mean times beside the paper's", PAPER, gaps,
                  lambda: table1_body(data, tables, faults, files)),
        page.Section("verdicts", "Verdicts: what of the paper holds here", verdicts_body(verdicts, files),
                     PAPER)
    ]
    sections += [_figure(data, files, figure, BEYOND, gaps) for figure in FIGURES if not figure.paper]
    sections += [_replay(directory, files, gaps),
                 page.Section("runs", "What was run", runs_body(data.tree.experiments), RUNS),
                 _messages(data)]
    return [_summary(data, tables, verdicts, gaps), *sections], gaps


def _with_gap(anchor, heading, group, gaps, make):
    """A section, or its place with the reason why it is not there."""
    try:
        body = make()
    except (NoData, ResultError) as reason:
        gaps.append((anchor, heading, str(reason)))
        body = page.gap(reason)
    return page.Section(anchor, heading, body, group)


def _figure(data, files, figure, group, gaps):

    def make():
        drawn, caption = figure.draw(data)
        pdf, png = style.save(drawn, files, figure.name)
        return page.picture(png, caption, [("PDF", pdf, "application/pdf")])

    for ending in ("pdf", "png"):  # of an earlier report, which a gap must not leave behind
        (files / f"{figure.name}.{ending}").unlink(missing_ok=True)
    return _with_gap(figure.name.replace("_", "-"), figure.title, group, gaps, make)


def _rendered(files, name, heading, caption, gaps):
    """Figures that scripts/render_figures has made before."""

    def make():
        png, pdf, text = (files / f"{name}.{ending}" for ending in ("png", "pdf", "txt"))
        if not png.is_file():
            raise NoData("no motion recorded, or scripts/render_figures has not been run")
        downloads = [("PDF", pdf, "application/pdf")] if pdf.is_file() else []
        told = text.read_text(encoding="utf-8").strip() if text.is_file() else caption
        return page.picture(png, told, downloads)

    return _with_gap(name, heading, PAPER, gaps, make)


def _replay(directory, files, gaps):

    def make():
        fragment = _viewer(directory)
        strips = [
            page.picture(png, "One picture every so many steps, from the recorded motion.")
            for png in sorted(files.glob("film*strip*.png"))
        ]
        if not fragment and not strips:
            raise NoData("no motion recorded; cleave run --record-motion writes it")
        return fragment + "".join(strips)

    return _with_gap("replay", "Replay of a recorded run", RUNS, gaps, make)


def _viewer(directory):
    """HTML of the viewer; empty without a recorded motion."""
    fragment = viewer_section(directory)
    return "" if fragment == NO_MOTION else fragment


def _summary(data, tables, verdicts, gaps):
    rows = [experiment.rows[["status", "solver"]] for experiment in data.tree.experiments]
    failed = [solver for frame in rows for solver in frame.loc[frame["status"] != "ok", "solver"]]
    whose = f", of {', '.join(sorted(set(failed)))}" if failed else ""
    entries = [(len(rows), "output directories", ""), (sum(map(len, rows)), "measured rows", ""),
               (len(failed), f"rows not ok{whose}", "no" if failed else "yes")]
    entries += [(sum(item.verdict == verdict
                     for item in verdicts), f"verdicts: {verdict}", css)
                for verdict, (css, _) in SIGNS.items()]
    return page.Section("summary", "Summary",
                        page.tiles(entries) + lowest_totals(tables) + _missing(gaps), "Overview")


def _missing(gaps):
    lines = [
        f'<li><a href="#{anchor}">{html.escape(heading)}</a>: {html.escape(reason)}</li>'
        for anchor, heading, reason in gaps
    ]
    return f"<h3>Not in this report</h3><ul>{''.join(lines)}</ul>" if lines else ""


def _messages(data):
    body = page.bullet_list(data.messages) if data.messages else "<p>None: every file was read whole.</p>"
    return page.Section("messages", "Messages", body, RUNS)
