"""Sheets of pictures from recorded motion: what figures 1 and 2 and the film strip share."""
import concurrent.futures
import os
import sys

import matplotlib
import numpy

from cleave_scripts.motion.looks import look_of
from cleave_scripts.motion.part_colouring import colour_bodies
from cleave_scripts.results.names import NO_PARTITIONER, in_order
from cleave_scripts.results.paper import BEST, COMBINATIONS, PARTITIONERS, REFINERS


def show(axes, picture):
    """A picture, or a marked gap with the reason."""
    axes.set_xticks([])
    axes.set_yticks([])
    for spine in axes.spines.values():
        spine.set_visible(False)
    if isinstance(picture, str):
        axes.add_patch(
            matplotlib.patches.Rectangle((0, 0),
                                         1,
                                         1,
                                         transform=axes.transAxes,
                                         facecolor="0.95",
                                         edgecolor="0.6",
                                         hatch="//",
                                         linewidth=0))
        axes.text(0.5,
                  0.5,
                  picture,
                  transform=axes.transAxes,
                  ha="center",
                  va="center",
                  fontsize=8,
                  wrap=True,
                  bbox={
                      "facecolor": "white",
                      "edgecolor": "none"
                  })
    else:
        axes.imshow(picture, interpolation="lanczos")


def frame_of(motion, index):
    return int(numpy.searchsorted(motion.step, motion.measured.step[index]))


def chosen_index(motion):
    """The measured step a scene is shown at, as an index; None where nothing was measured."""
    if len(motion.measured.step) == 0:
        return None
    wanted = look_of(motion).step
    index = motion.measured_index(motion.step[-1] if wanted is None else wanted)
    return 0 if index is None else index


def of_scene(motions, scene):
    return next((motion for motion in motions if motion.scene == scene), None)


def cells_of(motion):
    """(partitioner, refiner) -> position of the first combination that has them, less solvers of the whole system."""
    cells = {}
    for position, (partitioner, refiner, _) in enumerate(motion.combinations):
        if partitioner != NO_PARTITIONER:
            cells.setdefault((partitioner, refiner), position)
    return cells


def names_of(cells):
    """(partitioners, refiners) of cells, those of the paper first; the paper's where there are none."""
    names = cells or COMBINATIONS
    return (in_order((partitioner for partitioner, _ in names), PARTITIONERS),
            in_order((refiner for _, refiner in names), REFINERS))


def best_cell(cells):
    """Position of the combination that the paper recommends, else of the first; None where there is none."""
    return cells.get(BEST, next(iter(cells.values()), None))


def colours_of_cells(motion, index, cells):
    """Colours of bodies by cell: parts keep those of the cell above, in the first row of the cell before."""
    centres = motion.position[frame_of(motion, index)].astype(float)
    colours, before = {}, {}
    partitioners, refiners = names_of(cells)
    for partitioner, refiner in ((partitioner, refiner) for refiner in refiners for partitioner in partitioners):
        if (partitioner, refiner) in cells:
            part = motion.measured["part"][index, cells[partitioner, refiner]]
            alike = before.get(partitioner, before.get("last"))
            colour = colour_bodies(part, motion.measured.edges(index), centres, alike)
            colours[partitioner, refiner] = colour
            before[partitioner] = before["last"] = (part, colour)
    return colours


def side_by_side(jobs):
    """Makes pictures with all cores, in the order of the jobs: (what it is, function without arguments)."""

    def make(job):
        print(f"render_figures: {job[0]}", file=sys.stderr)
        return job[1]()

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        return list(pool.map(make, jobs))
