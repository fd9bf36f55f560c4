"""The film strip: pictures of recorded runs from step to step, by one camera that holds all of them."""
import functools

import matplotlib.pyplot as pyplot
import numpy

from cleave_scripts.motion.looks import look_of
from cleave_scripts.motion.part_colouring import colour_sequence
from cleave_scripts.motion.picture_sheets import best_cell, cells_of, show, side_by_side
from cleave_scripts.motion.pictures import Stage, picture_of_bodies
from cleave_scripts.results.names import title

PICTURE_IN = 2.0  # wide
ASPECT = 4 / 3


def frames_of(motion, every):
    return [frame for frame, step in enumerate(motion.step) if step % every == 0]


def stage_of(motion, frames, width):
    size = (width, round(width / ASPECT))
    return Stage(motion, frames, size, gathered_light=False, eye=look_of(motion).run_eye, tiles=True)


def colours_of(motion, frames, combination):
    """For every picture the colours of the bodies, by the last split; None before the first."""
    measured = motion.measured
    split = [(frame, index) for frame in frames
             if (index := motion.measured_index(motion.step[frame])) is not None]
    sequence = colour_sequence([measured["part"][index, combination] for _, index in split],
                               [measured.edges(index) for _, index in split],
                               [motion.position[frame].astype(float) for frame, _ in split])
    colours = dict(zip((frame for frame, _ in split), sequence))
    return [colours.get(frame) for frame in frames]


def draw(motions, options):
    strips, jobs = [], []
    for motion in motions:
        frames = frames_of(motion, options.every)
        combination = best_cell(cells_of(motion)) if options.colour == "part" else None
        colours = [None] * len(frames) if combination is None else colours_of(motion, frames, combination)
        stage = stage_of(motion, frames, round(options.width / 3))
        strips.append((motion, frames))
        jobs += [(f"film strip: {motion.scene}, step {motion.step[frame]}",
                  functools.partial(picture_of_bodies, stage, frame, colour))
                 for frame, colour in zip(frames, colours)]
    return _sheet(strips, iter(side_by_side(jobs)), options.columns)


def _sheet(strips, pictures, columns):
    lines = [-(-len(frames) // columns) for _, frames in strips]
    heights = [0.4 + 1.8 * count for count in lines]
    figure = pyplot.figure(figsize=(PICTURE_IN * columns, sum(heights)), layout="constrained")
    figure.get_layout_engine().set(w_pad=0.01, h_pad=0.04, wspace=0, hspace=0)
    parts = numpy.atleast_1d(figure.subfigures(len(strips), 1, height_ratios=heights))
    for part, (motion, frames), count in zip(parts, strips, lines):
        part.suptitle(f"{title(motion.scene)}, {motion.bodies} bodies", fontsize=14, x=0.01, ha="left")
        grid = part.subplots(count, columns, squeeze=False)
        for axes in grid.ravel()[len(frames):]:
            axes.set_visible(False)
        for axes, frame in zip(grid.ravel(), frames):
            show(axes, next(pictures))
            seconds = motion.step[frame] * motion.attributes["h_s"]
            axes.set_xlabel(f"step {motion.step[frame]}, {seconds:.2f} s", fontsize=12)
    return figure
