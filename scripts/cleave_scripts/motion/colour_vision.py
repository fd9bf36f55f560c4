"""How different colours look, to usual eyes and to red-green blind ones."""
import numpy

# Linear RGB as it looks to those without working green (deutan) or red (protan) cones: Machado, Oliveira and
# Fernandes 2009, severity 1.
VISIONS = {
    "usual":
        numpy.eye(3),
    "deuteranopia":
        numpy.array([[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413],
                     [-0.011820, 0.042940, 0.968881]]),
    "protanopia":
        numpy.array([[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216],
                     [-0.003882, -0.048116, 1.051998]]),
}
TO_XYZ = numpy.array([[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750],
                      [0.0193339, 0.1191920, 0.9503041]])
LAB_LINEAR_BELOW = 216 / 24389
LAB_SLOPE = 24389 / 27


def linear(srgb):
    srgb = numpy.asarray(srgb, float)
    return numpy.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055)**2.4)


def cielab(linear_rgb):
    """L*, a*, b* under daylight D65."""
    relative = numpy.clip(linear_rgb, 0, 1) @ TO_XYZ.T / TO_XYZ.sum(axis=1)
    x, y, z = numpy.moveaxis(
        numpy.where(relative > LAB_LINEAR_BELOW, numpy.cbrt(relative), (LAB_SLOPE * relative + 16) / 116), -1,
        0)
    return numpy.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)], -1)


def contrast(colours, others):
    """(c, o): CIELAB distances (1976) of sRGB colours to others, for the eyes that tell them least apart."""
    colours, others = linear(colours), linear(others)
    return numpy.min([
        numpy.linalg.norm(
            cielab(colours @ vision.T)[:, None] - cielab(others @ vision.T)[None], axis=-1)
        for vision in VISIONS.values()
    ],
                     axis=0)
