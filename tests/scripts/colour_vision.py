"""How far apart colours look to normal and to red-green blind eyes (CIE 1976 colour difference).

Deuteranopia by the matrix of Machado, Oliveira and Fernandes (2009) in linear RGB.
"""
import itertools

import numpy
from matplotlib.colors import to_rgb

DEUTERANOPIA = numpy.array([[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413],
                            [-0.011820, 0.042940, 0.968881]])
XYZ = numpy.array([[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750],
                   [0.0193339, 0.1191920, 0.9503041]])
WHITE = XYZ.sum(axis=1)


def _linear(color):
    parts = numpy.array(to_rgb(color))
    return numpy.where(parts <= 0.04045, parts / 12.92, ((parts + 0.055) / 1.055)**2.4)


def _lab(linear):
    share = XYZ @ linear / WHITE
    root = numpy.where(share > 216 / 24389, numpy.cbrt(share), (24389 / 27 * share + 16) / 116)
    return numpy.array([116 * root[1] - 16, 500 * (root[0] - root[1]), 200 * (root[1] - root[2])])


def difference(first, second):
    """The smaller of the differences that normal and red-green blind eyes see; 2.3 is just noticeable."""
    first, second = _linear(first), _linear(second)
    blind = (numpy.clip(DEUTERANOPIA @ color, 0, 1) for color in (first, second))
    return min(numpy.linalg.norm(_lab(one) - _lab(other)) for one, other in ((first, second), tuple(blind)))


def closest(colors):
    """(difference, name, name) of the two of {name: colour} that look most alike."""
    return min((difference(colors[one], colors[other]), one, other)
               for one, other in itertools.combinations(colors, 2))
