"""One page layout for all figures: sizes, lines, legends, and the files they are saved to; colours are in looks.py."""
import itertools

import matplotlib

matplotlib.use("Agg")
import matplotlib.colors
import matplotlib.lines
import matplotlib.patches
import matplotlib.ticker
import matplotlib.pyplot as pyplot

from cleave_scripts.figures import looks
from cleave_scripts.results.names import NO_PARTITIONER
from cleave_scripts.results.whole_file import written_aside

WIDTH_IN = 7.4
PNG_DPI = 200
INK, MUTED, GRID, FAILED = "#1a1a1a", "#6b6b6b", "#dddddd", "#b34700"

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


def refiner_patches(refiners):
    """Legend entries that explain the hatches."""
    return [
        matplotlib.patches.Patch(label=refiner, **looks.bar_look(NO_PARTITIONER, refiner)) for refiner in refiners
    ]


def refiner_marks(refiners):
    """Legend entries that explain the markers of refiners."""
    return [
        matplotlib.lines.Line2D([], [], **looks.line_look(NO_PARTITIONER, name) | {"linestyle": "none"}, label=name)
        for name in refiners
    ]


def solver_marks(solvers):
    """Legend entries that explain the markers of solvers."""
    return [
        matplotlib.lines.Line2D([], [], **looks.solver_look(name), linestyle="none", markersize=6, label=name)
        for name in looks.solvers_in(solvers)
    ]


def partitioner_patches(partitioners):
    return [
        matplotlib.patches.Patch(color=looks.color(name), label="whole system" if name == NO_PARTITIONER else name)
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
    """About how wide a legend gets; lengths: letters of its entries, which go down the columns one by one, the first of
    them longer where the entries do not go into equal ones."""
    rows, longer = divmod(len(lengths), columns)
    ends = [0, *itertools.accumulate(rows + (column < longer) for column in range(columns))]
    return sum(0.062 * max(lengths[first:last]) + 0.5 for first, last in itertools.pairwise(ends))


def short(value):
    """Three digits, without an exponent for what a reader would write out: 25.3, 2180, 0.0123."""
    return f"{value:.0f}" if 1000 <= abs(value) < 1e6 else f"{value:.3g}"


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
    paths = []
    for ending, options in (("pdf", {"metadata": {"CreationDate": None}}),
                            ("png", {"metadata": {"Software": None}, "dpi": PNG_DPI})):
        paths.append(directory / f"{name}.{ending}")
        with written_aside(paths[-1]) as part:
            figure.savefig(part, format=ending, **options)
    pyplot.close(figure)
    return paths
