"""What a solver's errors do to a motion that it moves alone, against what its steps cost."""
from cleave_scripts.figures import looks, style
from cleave_scripts.figures.time_to_accuracy import legend_lines
from cleave_scripts.figures.tree import NoData
from cleave_scripts.measurements.accuracy import EXACT

LEAST_M = 1e-6  # drawn where a length is less
SPECIAL = {EXACT: {"marker": "*", "markersize": 11, "color": style.INK, "zorder": 5}}


def motion(data):
    """Figure of the report, with its caption."""
    if data.tree.motions is None:
        raise NoData("no tradeoff_motion.csv with rows; scripts/tradeoff writes one")
    return draw_motions(data.tree.motions), (
        "Scenes that one solver alone has moved: joint drift, or penetration where there are no joints, and the height of the "
        f"middle of the mass over that under {EXACT}, means over the second half of the measured steps, against the mean t_s "
        "of a step, of all substeps where it has several. A line joins what differs in sweeps, iterations or substeps alone.")


def draw_motions(found):
    places = list(dict.fromkeys(of.place for of in found))
    figure, axes = style.panels(2 * len(places), 2, 1.75)
    looked = _looks(found)
    for place, error, height in zip(places, axes[::2], axes[1::2]):
        here = [of for of in found if of.place == place]
        length = "joint_drift_m" if any(of.mean_later("joint_drift_m") > 0 for of in here) else "max_penetration_m"
        exact = next((of for of in here if of.mover == EXACT), here[0])
        error.set_title(here[0].title)
        error.set(yscale="log", ylabel=("joint drift" if length == "joint_drift_m" else "penetration") + ", mm")
        height.set(ylabel=f"height over {EXACT}'s")
        _points(error, here, looked, lambda of: 1000 * max(of.mean_later(length), LEAST_M))
        _points(height, here, looked, lambda of: of.mean_later("potential_energy_j") / exact.mean_later("potential_energy_j"))
        for ax in (error, height):
            ax.set(xscale="log", xlabel="$t_s$ of a step, ms")
            _few_ticks(ax.xaxis)
        _few_ticks(error.yaxis)
    style.legend_above(figure, legend_lines(looked), columns=4)
    return figure


def _few_ticks(axis):
    """1, 2, 5, 10, ... as a reader would write them."""
    axis.set_major_locator(style.matplotlib.ticker.LogLocator(subs=(1, 2, 5)))
    axis.set_minor_locator(style.matplotlib.ticker.NullLocator())
    axis.set_major_formatter(style.matplotlib.ticker.FuncFormatter(lambda value, _: style.short(value)))


def _looks(found):
    return {family: {"linewidth": 0.9, "linestyle": looks.LINES[place // len(looks.CYCLE)], "markersize": 4, **look,
                     "color": looks.readable(look["color"]), **SPECIAL.get(family, {})}
            for place, (family, look) in enumerate(looks.marks(dict.fromkeys(of.family for of in found)).items())}


def _points(ax, found, looked, value):
    """A point a mover, those of a family joined from the cheapest on."""
    for family, look in looked.items():
        mine = sorted((of.step_ms, value(of)) for of in found if of.family == family)
        ax.plot([time for time, _ in mine], [height for _, height in mine], **look)
