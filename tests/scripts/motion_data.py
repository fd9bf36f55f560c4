"""A small made-up motion.h5, as `cleave run --record-motion` writes it, with a body of every shape."""
import pathlib

import h5py
import numpy

import synthetic  # noqa: F401  (makes scripts/ importable)
from cleave_scripts.motion.recording import GEOM_TYPES, NO_PART
from cleave_scripts.results.paper import PARTITIONERS, REFINERS

STEPS, EVERY, BODIES = 30, 3, 6
# What each body is made of: (kind, size). Body 5 is a clump of two spheres.
SHAPES = [("box", (0.6, 0.5, 0.7)), ("sphere", (0.3, 0, 0)), ("capsule", (0.15, 0.5, 0)),
          ("cylinder", (0.2, 0.6, 0)), ("convex", (0, 0, 0)), ("sphere", (0.25, 0, 0)),
          ("sphere", (0.2, 0, 0))]
BODY_OF_SHAPE = [0, 1, 2, 3, 4, 5, 5]
CORNERS = 0.3 * numpy.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1.2)], float)
EDGES = numpy.array([(0, 1), (1, 2), (2, 3), (3, 4), (0, 4), (4, 5)])


def combinations(solvers=("schur",), without_parts=("pgs",)):
    names = [
        f"{partitioner}+{refiner}+{solver}" for partitioner in PARTITIONERS for refiner in REFINERS
        for solver in solvers
    ]
    return names + [f"-+-+{solver}" for solver in without_parts]


def positions():
    """Bodies in a ring that sink to the ground and drift apart."""
    angle = numpy.arange(BODIES) * 2 * numpy.pi / BODIES
    time = numpy.arange(STEPS)[:, None] / STEPS
    return numpy.stack([(0.9 + 0.2 * time) * numpy.cos(angle),
                        (0.9 + 0.2 * time) * numpy.sin(angle), 2.0 - 1.6 * time + 0 * angle], -1).astype("f4")


def orientations():
    angle = numpy.linspace(0, 1, STEPS)[:, None] * numpy.arange(1, BODIES + 1)
    return numpy.stack([numpy.cos(angle), numpy.sin(angle), 0 * angle, 0 * angle], -1).astype("f4")


def part_of(step_index, combination):
    """Two or three parts that depend on the combination and change once."""
    bodies = numpy.arange(BODIES)
    return (bodies + combination + step_index // 5) % (2 + combination % 2)


def write_motion(directory, scene="rock_pile", labels=None, walls=False, change=None, **attributes):
    """change(file) may spoil it before it is closed."""
    directory = pathlib.Path(directory)
    directory.mkdir(parents=True, exist_ok=True)
    labels = combinations() if labels is None else labels
    with h5py.File(directory / "motion.h5", "w") as file:
        file.attrs.update({
            "schema": "cleave-motion-1",
            "run_id": "0123456789abcdef",
            "scene": scene,
            "seed": 1,
            "h_s": 1 / 60,
            "steps": STEPS,
            "measure_every": EVERY,
            "combinations": ",".join(labels),
            **attributes
        })
        file["mass"] = numpy.full(BODIES, 100.0)
        file["step"] = numpy.arange(STEPS, dtype="i4")
        file["position"], file["orientation"] = positions(), orientations()
        _write_measured(file.create_group("measured"), labels)
        _write_shapes(file.create_group("shape"), walls)
        if change:
            change(file)
    return directory / "motion.h5"


def _write_measured(group, labels):
    steps = numpy.arange(EVERY - 1, STEPS, EVERY)
    k, c = len(steps), len(labels)
    part = numpy.empty((k, c, BODIES), "u2")
    for i in range(k):
        for j, label in enumerate(labels):
            part[i, j] = NO_PART if label.startswith("-") else part_of(i, j)
    cut = part[..., EDGES[:, 0]] != part[..., EDGES[:, 1]]
    group["step"] = steps.astype("i4")
    group["island"] = numpy.zeros((k, BODIES), "u2")
    group["edge_count"] = numpy.full(k, len(EDGES), "i4")
    group["edge"] = numpy.tile(EDGES, (k, 1)).astype("u2")
    group["part"] = part
    group["interface"] = numpy.zeros((k, c, BODIES), "u1")
    random = numpy.random.default_rng(3)
    group["residual_m_per_s"] = (10.0**random.uniform(-16, -10, (k, c, BODIES))).astype("f4")
    group["largest_impulse_n_s"] = (10.0**random.uniform(-1, 3, (k, c, BODIES))).astype("f4")
    group["largest_impulse_n_s"][0, 0, :2] = (0, numpy.nan)
    group["t_s_ms"] = random.uniform(1, 9, (k, c)).astype("f4")
    group["t_pr_ms"] = random.uniform(0, 1, (k, c)).astype("f4")
    group["interface_rows"] = (3 * cut.sum(axis=-1)).astype("i4")
    group["ok"] = numpy.ones((k, c), "u1")


def _write_shapes(group, walls):
    """The geoms in the world at the first step, then static planes."""
    position, orientation = positions()[0], orientations()[0]
    planes = [((0, 0, 0), (1, 0, 0, 0))]
    if walls:
        half = numpy.sqrt(0.5)
        planes += [((-2, 0, 0), (half, 0, half, 0)), ((2, 0, 0), (half, 0, -half, 0)),
                   ((0, -2, 0), (half, -half, 0, 0)), ((0, 2, 0), (half, half, 0, 0))]
    # The second ball of the clump stands beside the first, along an axis that the body's first turn leaves.
    aside = [(0, 0, 0)] * 6 + [(0.3, 0, 0)]
    group["geom_body"] = numpy.array(BODY_OF_SHAPE + [-1] * len(planes), "i4")
    group["geom_type"] = numpy.array([GEOM_TYPES.index(kind) for kind, _ in SHAPES] +
                                     [GEOM_TYPES.index("plane")] * len(planes), "u1")
    group["geom_size"] = numpy.array([size for _, size in SHAPES] + [(0, 0, 0)] * len(planes), float)
    group["geom_position"] = numpy.array(
        [position[body] + offset for body, offset in zip(BODY_OF_SHAPE, aside)] +
        [place for place, _ in planes])
    group["geom_orientation"] = numpy.array([orientation[body] for body in BODY_OF_SHAPE] +
                                            [turn for _, turn in planes])
    group["convex_points"] = CORNERS
    group["convex_first"] = numpy.array([0] * 5 + [8] * (len(SHAPES) - 4 + len(planes)), "i4")
