"""Colours, marks and lines by place: names get places as they are met in the data, those of the paper before all others.

Any two colours of the cycle differ for red-green blind readers too, by lightness or by blue against yellow; they were
found by search. Refiners are told apart by hatch and tint (bars) or marker and line style (curves).
"""
import matplotlib.colors

from cleave_scripts.results.names import NO_PARTITIONER, base_name, in_order
from cleave_scripts.results.paper import PARTITIONERS, REFINERS

CYCLE = ("#0072B2", "#B84000", "#00916A", "#E0A2CC", "#F0B000", "#0000FF", "#0FF096", "#2D1EA5", "#5A78FF", "#780F00",
         "#690F69", "#C3A5FF", "#00A54B", "#B4FF78")
WHOLE_SYSTEM = "#333333"  # where there is no partitioner
TINTS, HATCHES = (1.0, 0.62, 0.28), (None, "////", "....", "xxxx", "++++", "\\\\\\\\", "oooo", "----")
LINES = ("-", "--", ":", "-.", (0, (5, 1, 1, 1, 1, 1)), (0, (8, 2)), (0, (1, 3)))
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "<", ">", "p", "h", "*", "d", "8", "H")
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


class Places:
    """The place of every name that was met; those of `first` have theirs before."""

    def __init__(self, first=()):
        self.first = tuple(first)
        self.forget()

    def forget(self):
        self._places = {name: index for index, name in enumerate(self.first)}

    def of(self, name):
        return self._places.setdefault(name, len(self._places))

    def sort(self, names):
        """The names by their places, those without a partitioner last."""
        names = in_order(names)
        there = sorted((name for name in names if name != NO_PARTITIONER), key=self.of)
        return there + [NO_PARTITIONER] * (NO_PARTITIONER in names)


_partitioners, _refiners, _solvers = Places(PARTITIONERS), Places(REFINERS), Places()


def meet(frames):
    """Gives places to the names of these rows, and forgets all others."""
    for places, column in ((_partitioners, "partitioner"), (_refiners, "refiner"), (_solvers, "solver")):
        places.forget()
        names = [name for frame in frames for name in frame[column].unique()]
        places.sort(map(base_name, names) if column == "solver" else names)


def partitioners_in(names):
    return _partitioners.sort(names)


def refiners_in(names):
    return _refiners.sort(names)


def solvers_in(names):
    return _solvers.sort(names)


def color(partitioner):
    """The same for a name in every figure."""
    return WHOLE_SYSTEM if partitioner == NO_PARTITIONER else _cycled(CYCLE, _partitioners.of(partitioner))


def solver_look(solver):
    """Colour and marker as keyword arguments, the same for a solver in every figure, whatever its parameters."""
    return _mark(_solvers.of(base_name(solver)))


def _mark(place):
    return {"color": _cycled(CYCLE, place), "marker": _cycled(MARKERS, place)}


def marks(names):
    """{name: colour and marker} of names that only one figure has."""
    return {name: _mark(place) for place, name in enumerate(names)}


def stage_colors(stages):
    """{stage: colour}; stages that came later get colours of the cycle."""
    later = [name for name in stages if name not in STAGES]
    return {name: STAGES.get(name) or _cycled(CYCLE, later.index(name)) for name in stages}


def _cycled(values, place):
    return values[place % len(values)]


def tint(base, strength):
    """The colour mixed with white; strength 1 leaves it."""
    return tuple(1 - strength * (1 - part) for part in matplotlib.colors.to_rgb(base))


def shades(count):
    """As many tints of the first colour, from light to full."""
    return [tint(CYCLE[0], 0.3 + 0.7 * place / max(1, count - 1)) for place in range(count)]


def _rank(refiner):
    return 0 if refiner == NO_PARTITIONER else _refiners.of(refiner)


def bar_look(partitioner, refiner):
    """Keyword arguments of a bar."""
    base, rank = color(partitioner), _rank(refiner)
    strength = TINTS[min(rank, len(TINTS) - 1)]
    return {"facecolor": tint(base, strength), "edgecolor": base, "hatch": _cycled(HATCHES, rank), "linewidth": 0.7}


def line_look(partitioner, refiner):
    """Keyword arguments of a curve."""
    rank = _rank(refiner)
    return {"color": color(partitioner), "linestyle": _cycled(LINES, rank), "marker": _cycled(MARKERS, rank)}


def readable(base):
    """The colour darkened until small text in it can be read on white."""
    parts = matplotlib.colors.to_rgb(base)
    while 0.2126 * parts[0] + 0.7152 * parts[1] + 0.0722 * parts[2] > 0.45:
        parts = tuple(0.9 * part for part in parts)
    return parts
