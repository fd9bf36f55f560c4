"""Colours of parts, islands and the constraint graph; figures and viewer take them from here.

Chosen by search: usual and red-green blind eyes tell any two colours of parts apart, and none is red, which
is the colour of constraints between parts. Red-green blind eyes take red for brown or olive; the casing tells
such a line from parts of these colours.
"""
PART_COLOURS = tuple(
    tuple(int(code[i:i + 2], 16) / 255 for i in (0, 2, 4))
    for code in ("2d5ad2", "f0b42d", "87e1c3", "965a00", "d287ff", "00694b", "a5e178", "3c5a96", "e1c3ff",
                 "4b96a5", "87965a"))
NODE = (0.13, 0.42, 0.86)  # of the constraint graph
EDGE = (0.80, 0.0, 0.08)  # between parts, or where there are none
EDGE_CASING = (1.0, 1.0, 1.0)
INNER_EDGE = (0.45, 0.47, 0.50)  # inside a part
EDGE_CASING_SCALE = 1.9  # width of the casing over that of its line
