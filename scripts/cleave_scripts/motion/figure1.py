"""Figure 1 of the paper: the scenes with their constraint graph."""
import functools
import string

import matplotlib.pyplot as pyplot

from cleave_scripts.motion.picture_sheets import chosen_index, frame_of, of_scene, show, side_by_side
from cleave_scripts.motion.pictures import Stage, picture_with_graph
from cleave_scripts.results.names import title
from cleave_scripts.results.paper import PAPER

SCENES = PAPER["figure1"]["scenes"]


def draw(motions, options):
    width = options.width
    shown = {}
    for scene in SCENES:
        motion = of_scene(motions, scene)
        index = chosen_index(motion) if motion else None
        if index is not None:
            shown[scene] = (Stage(motion, [frame_of(motion, index)], (width, round(0.86 * width))), index)
    pictures = side_by_side([(f"figure 1: {scene}",
                              functools.partial(picture_with_graph, stage, frame_of(stage.motion, index),
                                                index)) for scene, (stage, index) in shown.items()])
    pictures = dict(zip(shown, pictures))

    figure, all_axes = pyplot.subplots(1, len(SCENES), figsize=(4 * len(SCENES), 4.5), layout="constrained")
    for axes, scene, letter in zip(all_axes, SCENES, string.ascii_lowercase):
        show(axes, pictures.get(scene, "no measured step recorded"))
        caption = f"({letter}) {title(scene)}"
        if scene in shown:
            stage, index = shown[scene]
            measured = stage.motion.measured
            caption += (f", step {measured.step[index]}\n{stage.motion.bodies} bodies, "
                        f"{len(measured.edges(index))} edges")
        axes.set_xlabel(caption, fontsize=16)
    return figure
