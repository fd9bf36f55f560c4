"""The verdict map: every claim of the paper against what the paper leaves open,
as the share of the settings in which it holds."""
import numpy

from cleave_scripts.figures import style
from cleave_scripts.figures.tree import CLAIMS_FILE, NoData
from cleave_scripts.results.names import in_order

BY = {"cut": "interface rows", "time": "time"}
WIDE = 4  # columns, of a group whose heading fits two lines
ORDERS = ("scene", "random")


def draw(data):
    if data.tree.claims is None:
        raise NoData(f"no {CLAIMS_FILE}; scripts/hidden_choices --report writes one")
    return draw_map(data.tree.claims)


def draw_map(rows):
    """rows: frame of hidden_choices_claims.csv. (figure, caption)"""
    claims = list(dict.fromkeys(zip(rows["claim"], rows["row"])))
    columns = [(by, order, size) for by in BY for order in in_order(rows["order"], ORDERS)
               for size in sorted(rows.loc[(rows["by"] == by) & (rows["order"] == order), "max_bodies"].unique())]
    if not claims or not columns:
        raise NoData("no row of a claim")
    shares = numpy.full((len(claims), len(columns)), numpy.nan)
    texts = numpy.full(shares.shape, "", dtype=object)
    for row in rows.itertuples():
        place = claims.index((row.claim, row.row)), columns.index((row.by, row.order, row.max_bodies))
        if row.holds + row.fails > 0:  # else nobody can tell
            settings = row.holds + row.fails + row.cannot_tell
            shares[place], texts[place] = row.holds / settings, _share(row.holds, settings)
    figure, ax = style.pyplot.subplots(figsize=(style.WIDTH_IN + 1.6, 0.2 * len(claims) + 1.6))
    image = _cells(ax, shares, texts)
    ax.set_yticks(numpy.arange(len(claims)) + 0.5, _names(claims), fontsize=6.5)
    ax.set_xticks(numpy.arange(len(columns)) + 0.5, [size for _, _, size in columns], fontsize=6)
    ax.set_xlabel("n_max, bodies of a part")
    _groups(ax, columns)
    bar = figure.colorbar(image, ax=ax, label="settings in which it holds, %", pad=0.01, fraction=0.02)
    bar.ax.yaxis.set_major_formatter(style.matplotlib.ticker.PercentFormatter(1, symbol=""))
    bar.outline.set_visible(False)
    return figure, _caption(rows)


def _share(holds, settings):
    share = holds / settings
    return "" if share in (0, 1) else f"{100 * share:.0f}"


def _cells(ax, shares, texts):
    image = ax.pcolormesh(numpy.ma.masked_invalid(shares), cmap="cividis", vmin=0, vmax=1, edgecolors="white", linewidth=0.8)
    for (y, x), text in numpy.ndenumerate(texts):
        if text:
            ax.text(x + 0.5, y + 0.5, text, ha="center", va="center", fontsize=5.5,
                    color="white" if shares[y, x] < 0.55 else style.INK)
    ax.invert_yaxis()
    ax.grid(False)
    ax.tick_params(length=0)
    ax.spines[:].set_visible(False)
    return image


def _names(claims):
    """The claim beside its first part, the other parts alone."""
    names, last = [], None
    for claim, part in claims:
        names.append(f"{claim}:  {part}" if claim != last else part)
        last = claim
    return names


def _groups(ax, columns):
    """Lines between groups of columns, and what they are above them."""
    for group in dict.fromkeys((by, order) for by, order, _ in columns):
        places = [place for place, (by, order, _) in enumerate(columns) if (by, order) == group]
        order = f"{group[1]} order" if len(places) >= WIDE else f"{group[1]}\norder"
        ax.text((places[0] + places[-1] + 1) / 2, -0.25, f"{BY[group[0]]},\n{order}", ha="center", va="bottom", fontsize=6.5)
        if places[0] > 0:
            ax.axvline(places[0], color=style.INK, linewidth=0.9)


def _caption(rows):
    sums = rows.groupby("by")[["holds", "fails", "cannot_tell"]].sum().sum(axis=1)
    claims = rows.groupby("by").apply(lambda mine: len(mine[["claim", "row"]].drop_duplicates()))
    told = " and ".join(f"{sums[by] // claims[by]} by {BY[by]}" for by in BY if by in sums)
    return (f"Every claim of the paper that is about cells of its Table 1, in {told} settings: n_max, the order in which "
            "bodies are numbered, bfs that begins anew for each part or not, three thresholds of mr and three of mix. Bodies "
            "are in the scene's order, or in a random one. Yellow: holds in all; dark blue: in none; else per cent; white: it "
            "cannot be told. Interface rows are the same on every machine; they are no times, and of a gain of stated size "
            "they only say whether there is one.")
