"""Interface rows against t_s, with the cubic trend that a dense interface system suggests.

The trend is fitted only where the data can tell it; elsewhere a line has the slope of r^3 for comparison.
"""
import numpy

from cleave_scripts.figures import looks, style
from cleave_scripts.figures.choose import provenance, scenes_with
from cleave_scripts.figures.tree import NoData
from cleave_scripts.results.names import title

ITERATIONS = 200
DEAR = 1.5  # a combination is dear when it takes that many times the least time
FEWEST_DEAR, FEWEST_PARTITIONERS = 5, 2  # dear combinations, and partitioners among them, that bear a fit


def cubic_trend(rows_cut, times):
    """(a, c, share) of t = a + c r^3, a and c > 0, by least squares of log t (Gauss-Newton in log a, log c).

    share is the part of the variance of log t that the trend explains.
    """
    cubes = rows_cut**3
    logs = numpy.log(times)
    a, c = times.min(), (times / cubes).min()
    for _ in range(ITERATIONS):
        trend = a + c * cubes
        slopes = numpy.column_stack([a / trend, c * cubes / trend])
        step = numpy.linalg.lstsq(slopes, logs - numpy.log(trend), rcond=1e-9)[0]
        a, c = numpy.array([a, c]) * numpy.exp(numpy.clip(step, -1, 1))
    spread = ((logs - logs.mean())**2).sum()
    rest = ((logs - numpy.log(a + c * cubes))**2).sum()
    return a, c, 1 - rest / spread if spread > 0 else numpy.nan


def averages(rows):
    """A row a combination: cubic mean of its interface rows, mean of its times."""
    cubes = rows.assign(cubes=rows["interface_rows"]**3).groupby(["partitioner", "refiner"])
    return cubes.agg(r=("cubes", lambda values: values.mean()**(1 / 3)), t=("t_s_ms", "mean")).reset_index()


def bears_a_fit(means):
    """Whether enough points stand on the rise; otherwise the curve would be that of one partitioner."""
    dear = means[means["t"] > DEAR * means["t"].min()]
    return len(dear) >= FEWEST_DEAR and dear["partitioner"].nunique() >= FEWEST_PARTITIONERS


def draw(data):
    scenes, gaps = scenes_with(data.main, "interface_rows", "t_s_ms")
    scenes = {
        scene: rows[rows["interface_rows"].gt(0) & rows["t_s_ms"].gt(0)] for scene, rows in scenes.items()
    }
    if not any(map(len, scenes.values())):
        raise NoData("no row has interface rows")
    figure, axes = style.panels(len(data.main), 2, 2.6)
    for ax, scene in zip(axes, data.main):
        if len(scenes.get(scene, ())):
            _panel(ax, scenes[scene])
        else:
            _empty(ax, "no constraint is cut" if scene in scenes else "no data")
        ax.set_title(title(scene))
    names = looks.partitioners_in(name for rows in scenes.values() for name in rows["partitioner"])
    refiners = looks.refiners_in(name for rows in scenes.values() for name in rows["refiner"])
    marks = style.refiner_marks(refiners)
    style.legend_above(figure, [*style.partitioner_patches(names), *marks], columns=len(names) + len(marks))
    return figure, (
        "Mean time of a solve against the constraint rows r that the partition cuts; every point is one "
        "combination, and all of a panel solved the same steps. r is the cubic mean over the steps, the mean "
        "that a cubic law asks for. A curve is t = a + c r³, fitted to log t; R² is the share of its variance "
        f"that the trend explains. It is drawn where at least {FEWEST_DEAR} combinations of at least "
        f"{FEWEST_PARTITIONERS} partitioners take more than {DEAR} times the least time; elsewhere nothing "
        "is fitted, and the dashed line has the slope of r³ for comparison, through the point with most "
        "rows. " + gaps +
        provenance({title(scene): data.main[scene] for scene in scenes}))


def _panel(ax, rows):
    means = averages(rows)
    for _, mean in means.iterrows():
        look = {**looks.line_look(mean["partitioner"], mean["refiner"]), "linestyle": "none"}
        ax.plot(mean["r"], mean["t"], **look, markersize=6, markeredgecolor="white", markeredgewidth=0.6)
    limits = [0.9 * means["r"].min(), 1.1 * means["r"].max()]
    if bears_a_fit(means):
        a, c, share = cubic_trend(means["r"].to_numpy(), means["t"].to_numpy())
        x = numpy.geomspace(*limits, 100)
        ax.plot(x,
                a + c * x**3,
                color=style.INK,
                linewidth=1.1,
                zorder=1,
                label=rf"{style.short(a)} ms + {style.short(c * 1e9)} ms $(r / 1000)^3$, $R^2$ {share:.2f}")
    else:
        last = means.loc[means["r"].idxmax()]
        # Down to the least time only, so that the line does not stretch the panel.
        lowest = 0.97 * last["r"] * (means["t"].min() / last["t"])**(1 / 3)
        x = numpy.array([max(limits[0], lowest), limits[1]])
        ax.plot(x,
                last["t"] * (x / last["r"])**3,
                color=style.INK,
                linewidth=1.1,
                linestyle="--",
                zorder=1,
                label="slope of $r^3$, not fitted")
    ax.legend(loc="upper left")
    ax.set(xscale="log", yscale="log", xlabel="interface rows $r$", ylabel="mean $t_s$, ms")
    for axis, values in ((ax.xaxis, means["r"]), (ax.yaxis, means["t"])):
        digits = (1, 2, 5) if values.max() > 15 * values.min() else (1, 1.5, 2, 3, 4, 5, 6, 8)
        axis.set_major_locator(style.matplotlib.ticker.LogLocator(subs=digits))
        axis.set_major_formatter(style.matplotlib.ticker.FuncFormatter(lambda value, _: style.short(value)))
        axis.set_minor_locator(style.matplotlib.ticker.NullLocator())


def _empty(ax, reason):
    """The place of a scene that has no points."""
    ax.text(0.5, 0.5, reason, transform=ax.transAxes, ha="center", va="center", color=style.MUTED)
    ax.set(xticks=[], yticks=[], xlabel="interface rows $r$", ylabel="mean $t_s$, ms")
