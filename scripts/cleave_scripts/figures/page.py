"""Puts figures, tables and messages into one HTML file that needs no other."""
import base64
import dataclasses
import html
import pathlib

from cleave_scripts.figures.table_html import rich

PIXELS_PER_PIXEL = 1.5
CSS = pathlib.Path(__file__).with_name("page.css")


@dataclasses.dataclass
class Section:
    anchor: str
    heading: str
    body: str  # HTML
    group: str = ""  # heading above it in the table of contents; sections of a group follow each other


def data_uri(path, kind):
    return f"data:{kind};base64,{base64.b64encode(pathlib.Path(path).read_bytes()).decode()}"


def gap(reason):
    """The place of something that cannot be shown."""
    return f'<div class="missing">no data: {rich(reason)}</div>'


def _width_px(png):
    """On the page, where a pixel shows PIXELS_PER_PIXEL of the picture; its header says its width."""
    return round(int.from_bytes(pathlib.Path(png).read_bytes()[16:20], "big") / PIXELS_PER_PIXEL)


def picture(png, caption, downloads=()):
    """A figure with its caption and (label, file, media type) to save.

    A check box that is not seen shows it in full size and back, so that no script is needed.
    """
    links = " · ".join(download(*entry) for entry in downloads)
    alt = html.escape(caption, quote=True)
    return (f'<figure><label class="zoom" title="full size and back"><input type="checkbox" '
            f'aria-label="full size"><span class="frame"><img style="--width:{_width_px(png)}px" alt="{alt}" '
            f'src="{data_uri(png, "image/png")}"></span></label>'
            f'<figcaption>{rich(caption)} <span class="links">{links}</span></figcaption></figure>')


def download(label, path, kind):
    path = pathlib.Path(path)
    return f'<a download="{html.escape(path.name)}" href="{data_uri(path, kind)}">{html.escape(label)}</a>'


def tiles(entries):
    """Numbers at a glance: (number, what it is, style class)."""
    return '<div class="tiles">' + "".join(
        f'<div class="tile {css}"><b>{html.escape(str(number))}</b><span>{rich(text)}</span></div>'
        for number, text, css in entries) + "</div>"


def table(header, rows):
    """A plain table of texts."""
    cells = "".join(f"<th>{rich(text)}</th>" for text in header)
    body = "".join("<tr>" + "".join(f"<td>{rich(text)}</td>" for text in row) + "</tr>" for row in rows)
    return f'<div class="wide"><table><thead><tr>{cells}</tr></thead><tbody>{body}</tbody></table></div>'


def bullet_list(lines):
    return "<ul>" + "".join(f"<li>{rich(line)}</li>" for line in lines) + "</ul>"


def contents(sections):
    """The table of contents."""
    parts, group = [], None
    for section in sections:
        if section.group != group:
            group = section.group
            parts.append(f'<li class="part">{html.escape(group)}</li>')
        parts.append(f'<li><a href="#{section.anchor}">{rich(section.heading)}</a></li>')
    return f'<nav aria-label="contents"><ul>{"".join(parts)}</ul></nav>'


def page(title, subtitle, sections):
    """The whole document."""
    body = "".join(f'<section id="{section.anchor}"><h2>{rich(section.heading)}</h2>{section.body}</section>'
                   for section in sections)
    return (
        f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{html.escape(title)}</title>'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        # An empty icon keeps browsers from asking for one.
        f'<link rel="icon" href="data:,"><style>{CSS.read_text(encoding="utf-8")}</style></head><body>'
        f"<header><h1>{html.escape(title)}</h1><p>{rich(subtitle)}</p></header>"
        f'<div class="columns">{contents(sections)}<main>{body}</main></div></body></html>\n')
