"""Figure 2 of the paper: one step of a scene, split by every combination that was recorded."""
import functools

import matplotlib.pyplot as pyplot

from cleave_scripts.motion.picture_sheets import (cells_of, chosen_index, colours_of_cells, frame_of, names_of, of_scene,
                                                  show, side_by_side)
from cleave_scripts.motion.pictures import Stage, picture_of_parts
from cleave_scripts.results.names import title
from cleave_scripts.results.paper import PAPER

SCENE = PAPER["figure2"]["scene"]
CELL_IN, MARGIN_IN = (2.6, 2.1), 0.5
LONGEST_TITLE = 12  # letters that fit above a picture at full size


def draw(motions, options):
    motion = of_scene(motions, SCENE)
    index = chosen_index(motion) if motion else None
    cells = {} if index is None else cells_of(motion)
    partitioners, refiners = names_of(cells)
    width_in, height_in = CELL_IN[0] * len(partitioners), CELL_IN[1] * len(refiners) + MARGIN_IN
    figure, grid = pyplot.subplots(len(refiners), len(partitioners), figsize=(width_in, height_in), squeeze=False,
                                   layout="constrained")
    if cells:
        figure.suptitle(
            f"{title(motion.scene)}, step {motion.measured.step[index]}, {motion.bodies} bodies: "
            "colour = part, red = constraints between parts",
            fontsize=17)
    for axes, partitioner in zip(grid[0], partitioners):
        axes.set_title(partitioner, fontsize=_title_size(partitioner))
    for axes, refiner in zip(grid[:, 0], refiners):
        axes.set_ylabel(refiner, fontsize=_title_size(refiner))
    pictures = _pictures(motion, index, cells, options.width) if cells else {}
    rows_at = {cell: motion.measured["interface_rows"][index, position] for cell, position in cells.items()}
    for axes, cell in zip(grid.flat, ((partitioner, refiner) for refiner in refiners for partitioner in partitioners)):
        show(axes, pictures.get(cell, "not recorded"))
        if cell in rows_at:
            weight = "bold" if rows_at[cell] == min(rows_at.values()) else "normal"
            axes.set_xlabel(f"{rows_at[cell]} interface rows", fontsize=15, fontweight=weight)
    return figure


def _title_size(name):
    return 17 * min(1, LONGEST_TITLE / len(name))


def _pictures(motion, index, cells, width):
    """{cell: picture}"""
    stage = Stage(motion, [frame_of(motion, index)], (round(0.6 * width), round(0.42 * width)))
    colours = colours_of_cells(motion, index, cells)
    made = side_by_side([(f"figure 2: {' + '.join(cell)}",
                          functools.partial(picture_of_parts, stage, frame_of(motion, index), index, position, colours[cell]))
                         for cell, position in cells.items()])
    return dict(zip(cells, made))
