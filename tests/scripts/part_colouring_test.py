"""Colours of parts: told apart by usual and red-green blind eyes, and kept from picture to picture."""
import unittest

import numpy

import synthetic  # noqa: F401  (makes scripts/ importable)
from cleave_scripts.motion.colour_vision import VISIONS, cielab, contrast, linear
from cleave_scripts.motion.colours import EDGE, EDGE_CASING, PART_COLOURS
from cleave_scripts.motion.part_colouring import CONTRAST, colour_bodies, colour_sequence

LEAST_BETWEEN_PARTS = 24
LEAST_FROM_LINES = 35  # of a part from a line or its casing, whichever is seen better
LEAST_FROM_CASING = 60  # of a line
SIDE = 12  # of the grid of bodies below


def grid():
    """(edges, centres) of bodies on a square grid, each in contact with those beside it."""
    body = numpy.arange(SIDE**2).reshape(SIDE, SIDE)
    edges = numpy.concatenate([
        numpy.stack([body[:, :-1].ravel(), body[:, 1:].ravel()], -1),
        numpy.stack([body[:-1].ravel(), body[1:].ravel()], -1)
    ])
    row, column = numpy.divmod(numpy.arange(SIDE**2), SIDE)
    return edges, numpy.stack([row, column, 0 * row], -1).astype(float)


def blocks(side):
    """Part ids of square blocks of the grid."""
    row, column = numpy.divmod(numpy.arange(SIDE**2), SIDE)
    return row // side * SIDE + column // side


class VisionTest(unittest.TestCase):

    def test_known_colours(self):
        for colour, expected in (((1, 1, 1), (100, 0, 0)), ((1, 0, 0), (53.24, 80.09, 67.20)),
                                 ((0, 0, 1), (32.30, 79.19, -107.86)), ((0, 0, 0), (0, 0, 0))):
            numpy.testing.assert_allclose(cielab(linear(colour)), expected, atol=0.05)

    def test_grey_looks_grey_to_all_and_red_green_blind_eyes_confuse_red_and_olive(self):
        for vision in VISIONS.values():
            numpy.testing.assert_allclose(vision.sum(axis=1), 1, atol=2e-6)
        red, olive, blue = (0.8, 0.0, 0.1), (0.42, 0.37, 0.0), (0.2, 0.3, 0.9)
        usual = numpy.linalg.norm(cielab(linear(red)) - cielab(linear(olive)))
        self.assertGreater(usual, 50)
        self.assertLess(contrast([red], [olive])[0, 0], 15)
        self.assertGreater(contrast([red], [blue])[0, 0], 50)


class PaletteTest(unittest.TestCase):

    def test_any_two_colours_of_parts_are_told_apart(self):
        different = ~numpy.eye(len(PART_COLOURS), dtype=bool)
        self.assertGreater(CONTRAST[different].min(), LEAST_BETWEEN_PARTS)

    def test_cut_edges_are_seen_on_every_part(self):
        line_or_casing = contrast([EDGE, EDGE_CASING], PART_COLOURS).max(axis=0)
        self.assertGreater(line_or_casing.min(), LEAST_FROM_LINES)
        self.assertGreater(contrast([EDGE], [EDGE_CASING])[0, 0], LEAST_FROM_CASING)


class ColouringTest(unittest.TestCase):

    def assert_parts_are_whole_and_neighbours_differ(self, part, colour, edges):
        for each in numpy.unique(part):
            self.assertEqual(len(numpy.unique(colour[part == each])), 1)
        a, b = edges.T
        cut = part[a] != part[b]
        self.assertGreater(CONTRAST[colour[a], colour[b]][cut].min(), LEAST_BETWEEN_PARTS)

    def test_parts_that_share_constraints_differ_however_many_there_are(self):
        edges, centres = grid()
        for side in (6, 4, 3, 2, 1):
            part = blocks(side)
            colour = colour_bodies(part, edges, centres)
            self.assert_parts_are_whole_and_neighbours_differ(part, colour, edges)

    def test_parts_that_share_constraints_differ_however_far_they_are(self):
        random = numpy.random.default_rng(5)
        part, centres = numpy.arange(60), random.normal(size=(60, 3))
        edges = random.integers(60, size=(120, 2))
        edges = edges[edges[:, 0] != edges[:, 1]]
        self.assert_parts_are_whole_and_neighbours_differ(part, colour_bodies(part, edges, centres), edges)

    def test_parts_all_differ_while_there_are_colours(self):
        part = numpy.arange(len(PART_COLOURS))
        centres = numpy.random.default_rng(1).normal(size=(len(part), 3))
        colour = colour_bodies(part, numpy.zeros((0, 2), int), centres)
        self.assertEqual(len(set(colour)), len(part))

    def test_parts_keep_their_colours_when_they_are_renumbered(self):
        edges, centres = grid()
        part = blocks(3)
        colour = colour_bodies(part, edges, centres)
        for seed in range(5):
            renumbered = numpy.random.default_rng(seed).permutation(SIDE**2)[part]
            self.assertFalse((renumbered == part).all())
            later = colour_bodies(renumbered, edges, centres, (part, colour))
            numpy.testing.assert_array_equal(later, colour)

    def test_a_part_that_gives_bodies_away_keeps_its_colour(self):
        edges, centres = grid()
        part = blocks(4)
        later = part.copy()
        later[centres[:, 0] == 4] = part[centres[:, 0] == 3]  # a row of bodies goes to the parts beside it
        later = SIDE**2 - later
        first, second = colour_sequence([part, later], [edges] * 2, [centres] * 2)
        self.assert_parts_are_whole_and_neighbours_differ(later, second, edges)
        stayed = centres[:, 0] != 4
        numpy.testing.assert_array_equal(second[stayed], first[stayed])

    def test_of_two_halves_the_larger_one_keeps_the_colour(self):
        edges, centres = grid()
        part = numpy.zeros(SIDE**2, int)
        halves = numpy.where(centres[:, 1] < 5, 1, 0)
        first, second = colour_sequence([part, halves], [edges] * 2, [centres] * 2)
        self.assertTrue((second[halves == 0] == first[0]).all())
        self.assert_parts_are_whole_and_neighbours_differ(halves, second, edges)

    def test_parts_of_one_colour_that_come_to_touch_get_two(self):
        edges, centres = grid()
        part = blocks(6)
        before = (part, numpy.zeros(SIDE**2, int))  # far apart then, so that all may have had one colour
        colour = colour_bodies(part, edges, centres, before)
        self.assert_parts_are_whole_and_neighbours_differ(part, colour, edges)


if __name__ == "__main__":
    unittest.main()
