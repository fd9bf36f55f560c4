"""Which colour a part has: other than its neighbours', and in a row of pictures the one it had before.

There are more parts than colours that eyes tell apart, so distant parts share one.
"""
import numpy

from cleave_scripts.motion.colour_vision import contrast
from cleave_scripts.motion.colours import PART_COLOURS

CONTRAST = contrast(PART_COLOURS, PART_COLOURS)
ENOUGH_CONTRAST = 30.0  # between neighbours; more of it counts for less than distance from the same colour


def colour_bodies(part, edges, centres_m, before=None):
    """(n) for every body the index in PART_COLOURS of its part.

    part: (n) ids; edges: (e, 2) bodies that share constraints; before: (part, colour) of the picture before,
    both (n). Parts are matched with those before by the bodies they share, the greatest overlaps first.
    """
    index = numpy.unique(part, return_inverse=True)[1]
    size = numpy.bincount(index)
    middle_m = numpy.stack([numpy.bincount(index, axis) for axis in centres_m.T], -1) / size[:, None]
    palette = _Palette(_neighbours(index[edges], len(size)), middle_m)
    for each, colour in _inherited(index, before):
        palette.keep(each, colour)
    for each in numpy.argsort(-size, kind="stable"):
        palette.choose(each)
    return palette.colour[index]


def colour_sequence(part, edges, centres_m):
    """The same for successive pictures: each argument has an entry a picture."""
    colours, before = [], None
    for arguments in zip(part, edges, centres_m):
        colours.append(colour_bodies(*arguments, before))
        before = (arguments[0], colours[-1])
    return colours


class _Palette:
    """Colours of parts as far as they are chosen; -1 where not yet."""

    def __init__(self, neighbours, middle_m):
        self.neighbours = neighbours
        self.middle_m = middle_m
        self.colour = numpy.full(len(middle_m), -1)
        self.nearest_m = numpy.full((len(middle_m), len(PART_COLOURS)), numpy.inf)  # part of a colour

    def keep(self, part, colour):
        """The colour of the picture before, unless a neighbour has it already."""
        if colour not in self.colour[self.neighbours[part]]:
            self._set(part, colour)

    def choose(self, part):
        if self.colour[part] >= 0:
            return
        around = self.colour[self.neighbours[part]]
        clear = CONTRAST[:, around[around >= 0]].min(axis=1, initial=ENOUGH_CONTRAST)
        far_m = numpy.where(clear == clear.max(), self.nearest_m[part], -1)
        self._set(part, int(far_m.argmax()))

    def _set(self, part, colour):
        self.colour[part] = colour
        distance_m = numpy.linalg.norm(self.middle_m - self.middle_m[part], axis=1)
        self.nearest_m[:, colour] = numpy.minimum(self.nearest_m[:, colour], distance_m)


def _neighbours(pairs, count):
    """For every part the others that it shares an edge with."""
    found = [set() for _ in range(count)]
    for a, b in numpy.unique(pairs, axis=0).tolist():
        if a != b:
            found[a].add(b)
            found[b].add(a)
    return [sorted(each) for each in found]


def _inherited(index, before):
    """(part, colour before) by falling overlap; parts now and before are matched one to one."""
    if before is None:
        return []
    old, first, old_index = numpy.unique(before[0], return_index=True, return_inverse=True)
    shared, overlap = numpy.unique(numpy.stack([index, old_index], -1), axis=0, return_counts=True)
    matched, taken = [], numpy.zeros(len(old), bool)
    done = numpy.zeros(index.max() + 1, bool)
    for now, then in shared[numpy.argsort(-overlap, kind="stable")]:
        if not done[now] and not taken[then]:
            done[now] = taken[then] = True
            matched.append((now, before[1][first[then]]))
    return matched
