"""Interface rows against t_s, with the cubic trend that a dense interface system suggests."""
import numpy

from figures import style
from figures.choose import provenance, scenes_with, title
from figures.tree import NoData

ITERATIONS = 200


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


def draw(data):
    scenes, gaps = scenes_with(data.main, "interface_rows", "t_s_ms")
    scenes = {
        scene: rows[rows["interface_rows"].gt(0) & rows["t_s_ms"].gt(0)] for scene, rows in scenes.items()
    }
    scenes = {scene: rows for scene, rows in scenes.items() if len(rows)}
    if not scenes:
        raise NoData("no row has interface rows")
    figure, axes = style.panels(len(scenes), 2, 2.6)
    for ax, (scene, rows) in zip(axes, scenes.items()):
        _panel(ax, rows)
        ax.set_title(title(scene))
    names = style.partitioners_in(name for rows in scenes.values() for name in rows["partitioner"])
    refiners = style.refiners_in(name for rows in scenes.values() for name in rows["refiner"])
    marks = [
        style.matplotlib.lines.Line2D([], [],
                                      **{
                                          **style.line_look("-", name), "linestyle": "none"
                                      },
                                      label=name) for name in refiners
    ]
    style.legend_above(figure, [*style.partitioner_patches(names), *marks], columns=len(names) + len(marks))
    return figure, (
        "Mean time of a solve against the constraint rows r that the partition cuts; every point is one "
        "combination, and all of a panel solved the same steps. r is the cubic mean over the steps, the mean "
        "that a cubic law asks for. The curve is t = a + c r³, fitted to log t; R² is the share of its "
        "variance that the trend explains. " + gaps +
        provenance({title(scene): data.main[scene] for scene in scenes}))


def _panel(ax, rows):
    means = averages(rows)
    for _, mean in means.iterrows():
        look = {**style.line_look(mean["partitioner"], mean["refiner"]), "linestyle": "none"}
        ax.plot(mean["r"], mean["t"], **look, markersize=6, markeredgecolor="white", markeredgewidth=0.6)
    if means["r"].nunique() > 2:
        a, c, share = cubic_trend(means["r"].to_numpy(), means["t"].to_numpy())
        x = numpy.geomspace(0.9 * means["r"].min(), 1.1 * means["r"].max(), 100)
        ax.plot(x,
                a + c * x**3,
                color=style.INK,
                linewidth=1.1,
                zorder=1,
                label=rf"{style.short(a)} ms + {style.short(c * 1e9)} ms $(r / 1000)^3$, $R^2$ {share:.2f}")
        ax.legend(loc="upper left")
    ax.set(xscale="log", yscale="log", xlabel="interface rows $r$", ylabel="mean $t_s$, ms")
    for axis, values in ((ax.xaxis, means["r"]), (ax.yaxis, means["t"])):
        digits = (1, 2, 5) if values.max() > 15 * values.min() else (1, 1.5, 2, 3, 4, 5, 6, 8)
        axis.set_major_locator(style.matplotlib.ticker.LogLocator(subs=digits))
        axis.set_major_formatter(style.matplotlib.ticker.FuncFormatter(lambda value, _: style.short(value)))
        axis.set_minor_locator(style.matplotlib.ticker.NullLocator())
