"""Sheets of pictures from recorded motion: what figures 1 and 2 and the film strip share."""
import concurrent.futures
import os
import sys

import matplotlib
import numpy

from cleave_scripts.motion.part_colouring import colour_bodies
from cleave_scripts.results.paper import PARTITIONERS, REFINERS


def title_of(scene):
    return scene.replace("_", " ").title()


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


def cells_of(motion):
    """(partitioner, refiner) -> position of the first combination that has them; of those figure 2 shows."""
    cells = {}
    for position, (partitioner, refiner, _) in enumerate(motion.combinations):
        if partitioner in PARTITIONERS and refiner in REFINERS:
            cells.setdefault((partitioner, refiner), position)
    return cells


def colours_of_cells(motion, index, cells):
    """Colours of bodies by cell: parts keep those of the cell above, in the first row of the cell before."""
    centres = motion.position[frame_of(motion, index)].astype(float)
    colours, before = {}, {}
    for refiner in REFINERS:
        for partitioner in PARTITIONERS:
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
