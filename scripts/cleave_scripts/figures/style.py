"""One look for all figures: a colour a partitioner, a colour and a marker a solver, a colour a stage.

The colours of each kind are chosen so that red-green blind readers can tell any two of them apart too, by
lightness or by blue against yellow. Refiners are told apart by hatch and tint (bars) or marker and line
style (curves).
"""
import matplotlib

matplotlib.use("Agg")
import matplotlib.colors
import matplotlib.lines
import matplotlib.patches
import matplotlib.ticker
import matplotlib.pyplot as pyplot

from cleave_scripts.results.paper import PARTITIONERS, REFINERS
from cleave_scripts.results.steps import NO_PARTITIONER

WIDTH_IN = 7.4
PNG_DPI = 200
INK, MUTED, GRID, FAILED = "#1a1a1a", "#6b6b6b", "#dddddd", "#b34700"
COLORS = {
    "mindp": "#0072B2",
    "maxdp": "#B84000",
    "bfs": "#00916A",
    "mr": "#E0A2CC",
    "mix": "#F0B000",
    NO_PARTITIONER: "#333333"
}
FREE_COLORS = ("#56B4E9", "#882255", "#999933", "#F0E442")  # for names that come later
TINTS, HATCHES = (1.0, 0.62, 0.28), (None, "////", "....", "xxxx", "++++")
LINES, MARKERS = ("-", "--", ":", "-."), ("o", "s", "^", "D", "v", "P", "X", "<", ">", "p", "h", "*")
SOLVERS = {  # colour and marker
    "exact": ("#000000", "D"),
    "monolithic": ("#E07000", "v"),
    "schur": ("#0072B2", "s"),
    "pivot:schur-bodies": ("#2FBDE8", "P"),
    "dense": ("#43415F", "X"),
    "interior-point": ("#782430", "*"),
    "pgs": ("#00A862", "o"),
    "ode-step": ("#924D00", "h"),
    "ode-quickstep": ("#B060A0", "^"),
}
FREE_MARKERS = ("<", ">", "p", "d", "H", "8")  # for solvers that come later
STAGES = {
    "analyze": "#271459",
    "predict": "#7A9CF5",
    "assemble": "#C86400",
    "factor_local": "#1642C8",
    "form_interface": "#F0E578",
    "factor_interface": "#701A10",
    "solve": "#6FAE72",
    "check": "#0B0B0B",
    "refine": "#A8609C",
    "other": "#CCCCCC",
}

matplotlib.rcParams.update({
    "axes.axisbelow": True,
    "axes.edgecolor": MUTED,
    "axes.grid": True,
    "axes.labelcolor": INK,
    "axes.labelsize": 8.5,
    "axes.linewidth": 0.7,
    "axes.spines.right": False,
    "axes.spines.top": False,
    "axes.titlelocation": "left",
    "axes.titlesize": 9,
    "axes.titleweight": "bold",
    "errorbar.capsize": 0,
    "figure.constrained_layout.use": True,
    "font.family": "DejaVu Sans",
    "font.size": 8,
    "grid.color": GRID,
    "grid.linewidth": 0.5,
    "hatch.linewidth": 0.6,
    "legend.fontsize": 8,
    "legend.frameon": False,
    "lines.linewidth": 1.3,
    "lines.markersize": 4.5,
    "pdf.fonttype": 42,
    "xtick.color": MUTED,
    "xtick.labelcolor": INK,
    "xtick.labelsize": 8,
    "ytick.color": MUTED,
    "ytick.labelcolor": INK,
    "ytick.labelsize": 8,
})


def in_order(names, known):
    """Known names in their order, then the others by alphabet."""
    names = set(names)
    return [name for name in known if name in names] + sorted(names - set(known))


def partitioners_in(names):
    return in_order(names, (*PARTITIONERS, NO_PARTITIONER))


def refiners_in(names):
    return in_order(names, (*REFINERS, NO_PARTITIONER))


def give_colors(partitioners):
    """Gives names that came later a free colour each, by alphabet; colours repeat when they run out."""
    for index, name in enumerate(sorted(set(partitioners) - set(COLORS))):
        _given[name] = FREE_COLORS[index % len(FREE_COLORS)]


def give_looks(solvers):
    """Gives solvers that came later a free colour and marker each, by alphabet."""
    for index, name in enumerate(sorted(set(solvers) - set(SOLVERS))):
        _given_looks[name] = (FREE_COLORS[index % len(FREE_COLORS)], FREE_MARKERS[index % len(FREE_MARKERS)])


_given, _given_looks = {}, {}


def color(partitioner):
    """The same for a name in every figure."""
    return COLORS.get(partitioner) or _given.get(partitioner, FREE_COLORS[0])


def solver_look(solver):
    """Colour and marker as keyword arguments, the same for a solver in every figure."""
    base, marker = SOLVERS.get(solver) or _given_looks.get(solver, (FREE_COLORS[0], FREE_MARKERS[0]))
    return {"color": base, "marker": marker}


def stage_colors(stages):
    """{stage: colour}; stages that came later get a free colour each, by alphabet."""
    later = sorted(set(stages) - set(STAGES))
    free = {name: FREE_COLORS[index % len(FREE_COLORS)] for index, name in enumerate(later)}
    return {name: STAGES.get(name) or free[name] for name in stages}


def tint(base, strength):
    """The colour mixed with white; strength 1 leaves it."""
    return tuple(1 - strength * (1 - part) for part in matplotlib.colors.to_rgb(base))


def _rank(refiner):
    return REFINERS.index(refiner) if refiner in REFINERS else 0 if refiner == NO_PARTITIONER else len(
        REFINERS)


def bar_look(partitioner, refiner):
    """Keyword arguments of a bar."""
    base, rank = color(partitioner), _rank(refiner)
    return {
        "facecolor": tint(base, TINTS[min(rank,
                                          len(TINTS) - 1)]),
        "edgecolor": base,
        "hatch": HATCHES[rank],
        "linewidth": 0.7
    }


def line_look(partitioner, refiner):
    """Keyword arguments of a curve."""
    rank = _rank(refiner)
    return {"color": color(partitioner), "linestyle": LINES[rank], "marker": MARKERS[rank]}


def refiner_patches(refiners):
    """Legend entries that explain the hatches."""
    looks = {refiner: dict(bar_look(NO_PARTITIONER, refiner)) for refiner in refiners}
    return [matplotlib.patches.Patch(label=refiner, **look) for refiner, look in looks.items()]


def solver_marks(solvers):
    """Legend entries that explain the markers of solvers, in the order of SOLVERS."""
    return [
        matplotlib.lines.Line2D([], [], **solver_look(name), linestyle="none", markersize=6, label=name)
        for name in in_order(solvers, SOLVERS)
    ]


def partitioner_patches(partitioners):
    return [
        matplotlib.patches.Patch(color=color(name), label="whole system" if name == NO_PARTITIONER else name)
        for name in partitioners
    ]


def legend_above(figure, handles, columns):
    """A legend over all panels, for which the layout leaves room; narrower where it would not fit."""
    columns = min(columns, len(handles))
    while columns > 1 and _legend_width_in([len(handle.get_label())
                                            for handle in handles], columns) > figure.get_figwidth():
        columns -= 1
    rows = -(-len(handles) // columns)
    height_in = figure.get_figheight()
    figure.get_layout_engine().set(rect=(0, 0, 1, 1 - (0.17 * rows + 0.08) / height_in))
    figure.legend(handles=handles, loc="upper center", ncol=columns, columnspacing=1.4, borderaxespad=0.1)


def _legend_width_in(lengths, columns):
    """About how wide a legend gets; lengths: letters of its entries, which go down the columns one by one."""
    rows = -(-len(lengths) // columns)
    return sum(0.062 * max(lengths[first:first + rows]) + 0.5 for first in range(0, len(lengths), rows))


def short(value):
    """Three digits, without an exponent for what a reader would write out: 25.3, 2180, 0.0123."""
    return f"{value:.0f}" if 1000 <= abs(value) < 1e6 else f"{value:.3g}"


def readable(base):
    """The colour darkened until small text in it can be read on white."""
    parts = matplotlib.colors.to_rgb(base)
    while 0.2126 * parts[0] + 0.7152 * parts[1] + 0.0722 * parts[2] > 0.45:
        parts = tuple(0.9 * part for part in parts)
    return parts


def panels(count, columns=2, height_in=2.5, **options):
    """A figure with that many axes, row by row; those that are left over are removed."""
    columns = min(count, columns)
    rows = -(-count // columns)
    figure, axes = pyplot.subplots(rows,
                                   columns,
                                   figsize=(WIDTH_IN, height_in * rows + 0.35),
                                   squeeze=False,
                                   **options)
    axes = list(axes.flat)
    for spare in axes[count:]:
        spare.remove()
    return figure, axes[:count]


def save(figure, directory, name):
    """directory/name.pdf and .png; returns both paths. Equal input gives equal bytes."""
    directory.mkdir(parents=True, exist_ok=True)
    paths = [directory / f"{name}.{ending}" for ending in ("pdf", "png")]
    figure.savefig(paths[0], metadata={"CreationDate": None})
    figure.savefig(paths[1], dpi=PNG_DPI, metadata={"Software": None})
    pyplot.close(figure)
    return paths
