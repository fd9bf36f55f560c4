"""Places names beside points so that none leaves the axes, hides a point or another name."""
import dataclasses
import itertools

import numpy

FONT_SIZE = 7
PAD = 1.5  # pixels of free space around a text
GRID = 60  # places tried along each axis
STEP = 3  # pixels between the sampled points of a line
LEADER = 6  # pixels from text to point from which a line joins them
MARK = 5  # pixels from the middle of a mark to its rim
COST_OF_NAME, COST_OF_MARK, COST_OF_LINE = 1e6, 1e3, 6.0  # of covering one, in pixels of distance


@dataclasses.dataclass
class Label:
    text: str
    point: tuple  # in data coordinates
    color: object


def place(ax, labels, marks, lines):
    """Writes the labels in their order, each where it covers least and is nearest to its point.

    marks: points that are drawn; lines: lists of points that are joined; all in data coordinates. The
    limits of the axes have to be set, as the places are found in pixels.
    """
    figure = ax.figure
    figure.draw_without_rendering()
    frame = ax.get_window_extent()
    marks = ax.transData.transform(marks)
    path = [numpy.empty((0, 2))] + [_samples(ax.transData.transform(line)) for line in lines]
    taken, path = [], numpy.concatenate(path)
    for label in labels:
        text = ax.text(*label.point,
                       label.text,
                       fontsize=FONT_SIZE,
                       color=label.color,
                       linespacing=1.05,
                       ha="left",
                       va="bottom",
                       in_layout=False,
                       zorder=6)
        extent = text.get_window_extent()
        point = ax.transData.transform(label.point)
        size = numpy.array([extent.width, extent.height])
        corner = _best(frame, size, point, taken, marks, path)
        text.set_position(ax.transData.inverted().transform(corner))
        taken.append((corner, corner + size))
        end = numpy.clip(point, corner, corner + size)
        if numpy.hypot(*(end - point)) > LEADER:
            leader = numpy.array([point, end])
            ax.plot(*ax.transData.inverted().transform(leader).T,
                    color=label.color,
                    linewidth=0.5,
                    zorder=2,
                    in_layout=False,
                    scalex=False,
                    scaley=False)
            path = numpy.concatenate([path, _samples(leader)])


def _samples(points):
    """Points every STEP pixels along a line."""
    parts = [points[:1]]
    for start, end in zip(points, points[1:]):
        count = max(1, int(numpy.hypot(*(end - start)) / STEP))
        parts.append(start + (end - start) * numpy.linspace(0, 1, count + 1)[1:, None])
    return numpy.concatenate(parts)


def _best(frame, size, point, taken, marks, path):
    """The lower left corner of the cheapest place inside the frame."""
    corners = _corners(frame, size, point)
    low, high = corners - PAD, corners + size + PAD
    nearest = numpy.clip(point, corners, corners + size)
    cost = numpy.hypot(*(nearest - point).T)
    leaders = nearest[:, None] + (point - nearest)[:, None] * numpy.linspace(0, 1, 25)[None, :, None]
    for taken_low, taken_high in taken:
        cost += COST_OF_NAME * ((low < taken_high) & (high > taken_low)).all(axis=1)
        cost += COST_OF_MARK * ((leaders > taken_low) & (leaders < taken_high)).all(axis=2).any(axis=1)
    cost += COST_OF_MARK * _inside(marks, low - MARK, high + MARK)
    cost += COST_OF_LINE * _inside(path, low, high)
    return corners[numpy.argmin(cost)]


def _corners(frame, size, point):
    """Places all over the frame and, first, those that touch the point's own mark."""
    first = numpy.array([frame.x0, frame.y0]) + 2 * PAD
    last = numpy.maximum(numpy.array([frame.x1, frame.y1]) - size - 2 * PAD, first)
    gap = MARK + PAD + 0.5
    right_middle_left = (gap, -size[0] / 2, -gap - size[0])
    above_middle_below = (gap, -size[1] / 2, -gap - size[1])
    # The one in the middle of both would lie on the point.
    near = [point + shift for shift in itertools.product(right_middle_left, above_middle_below)]
    del near[4]
    grid = itertools.product(numpy.linspace(first[0], last[0], GRID), numpy.linspace(first[1], last[1], GRID))
    return numpy.clip([*near, *grid], first, last)


def _inside(points, low, high):
    """How many of the points lie in each box."""
    if not len(points):
        return numpy.zeros(len(low))
    return ((points > low[:, None]) & (points < high[:, None])).all(axis=2).sum(axis=1)
