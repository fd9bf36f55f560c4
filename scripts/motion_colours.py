"""Colours of parts and islands, without end, and colours of magnitudes; the same in figures and viewer."""
import numpy

NODE = (0.13, 0.42, 0.86)  # of the constraint graph
EDGE = (0.86, 0.16, 0.16)
# Hues go round by the golden ratio, so that the first few differ most, and leave out the reds, which are
# the constraints between parts. Lightness goes round in fives: ids 8, 13 or 21 apart have nearly the same
# hue, and a colour-blind reader confuses others.
GOLDEN_RATIO = (numpy.sqrt(5) - 1) / 2
HUES = numpy.radians([62, 345])
LIGHTNESS = (0.68, 0.84, 0.52, 0.76, 0.60)
CHROMA = 0.13


def part_colour(part):
    """sRGB in [0, 1] of a part or island id."""
    hue = HUES[0] + (HUES[1] - HUES[0]) * (GOLDEN_RATIO * part % 1)
    return oklch_to_srgb(LIGHTNESS[part % len(LIGHTNESS)], CHROMA, hue)


def oklch_to_srgb(lightness, chroma, hue):
    """From the perceptual space OKLCH (Ottosson 2020), cut off at the borders of sRGB."""
    a, b = chroma * numpy.cos(hue), chroma * numpy.sin(hue)
    cone = numpy.array([
        lightness + 0.3963377774 * a + 0.2158037573 * b, lightness - 0.1055613458 * a - 0.0638541728 * b,
        lightness - 0.0894841775 * a - 1.2914855480 * b
    ])**3
    linear = numpy.array([[4.0767416621, -3.3077115913, 0.2309699292],
                          [-1.2684380046, 2.6097574011, -0.3413193965],
                          [-0.0041960863, -0.7034186147, 1.7076147010]]) @ cone
    linear = numpy.clip(linear, 0, 1)
    return tuple(numpy.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear**(1 / 2.4) - 0.055))
