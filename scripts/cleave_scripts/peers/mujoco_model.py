"""A recorded pile as a model of MuJoCo: the same bodies, shapes, masses, friction, step and state."""
import h5py
import numpy

from cleave_scripts.motion.shapes import relative_pose, rotation_matrix
from cleave_scripts.results.errors import ResultError

GRAVITY_M_PER_S2 = numpy.array([0, 0, -9.81])
# By GeomType: what MuJoCo calls it, and its sizes from ours.
GEOMS = {
    0: ("box", lambda size: size / 2),
    1: ("sphere", lambda size: size[:1]),
    2: ("capsule", lambda size: [size[0], size[1] / 2]),
    3: ("cylinder", lambda size: [size[0], size[1] / 2]),
    5: ("plane", lambda size: [0, 0, 1]),
}
CONES = ("pyramidal", "elliptic")
# Numbers of 8 bytes that MuJoCo keeps ready for one step; it also keeps a dense matrix of as many rows as there may be.
STACK = 50_000_000

MODEL = """<mujoco>
  <compiler angle="radian"/>
  <option timestep="{step}" gravity="0 0 -9.81" cone="{cone}"/>
  <size njmax="{rows}" nconmax="{rows}" nstack="{stack}"/>
  <default><geom friction="{mu} 0 0" condim="3"/></default>
  <worldbody>
{static}
{bodies}
  </worldbody>
</mujoco>
"""


def most_rows(pile):
    """It may find more contacts than ODE, and its pyramids have four rows for our three."""
    return 1000 + 2 * len(pile["row_kind"])


def text_of(numbers):
    return " ".join(f"{number:.17g}" for number in numpy.ravel(numbers))


def read_pile(path):
    """The arrays of a problem file. A ResultError where it holds what this model has not: joints and convex shapes."""
    with h5py.File(path) as file:
        pile = {name: file[name][()] for name in ("mass", "free_velocity", "position", "orientation", "row_kind",
                                                  "friction_coefficient")}
        pile["step"] = file.attrs["h_s"]
        pile["geoms"] = list(zip(*(file["shape"][f"geom_{name}"][()] for name in ("body", "type", "size", "position",
                                                                                 "orientation"))))
        pile["velocity"] = next((solution["velocity"][()] for solution in file.get("solution", {}).values()), None)
    if (pile["row_kind"] == 0).any():
        raise ResultError(f"{path}: has joints, and only piles are stepped in MuJoCo")
    if not {kind for _, kind, *_ in pile["geoms"]} <= set(GEOMS):
        raise ResultError(f"{path}: has convex shapes, which are not written for MuJoCo")
    return pile


def _geom(kind, size, position, orientation):
    name, sizes = GEOMS[kind]
    return f'<geom type="{name}" size="{text_of(sizes(size))}" pos="{text_of(position)}" quat="{text_of(orientation)}"/>'


def _body(pile, body):
    pose = pile["position"][body], pile["orientation"][body]
    geoms = [_geom(kind, size, *relative_pose(pose, (position, orientation)))
             for of, kind, size, position, orientation in pile["geoms"] if of == body]
    turn = rotation_matrix(pile["orientation"][body])
    inertia = turn.T @ pile["mass"][body][3:, 3:] @ turn
    places = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
    inertial = (f'<inertial pos="0 0 0" mass="{pile["mass"][body][0, 0]:.17g}" '
                f'fullinertia="{text_of([inertia[place] for place in places])}"/>')
    return f'<body pos="{text_of(pose[0])}" quat="{text_of(pose[1])}"><freejoint/>{inertial}{"".join(geoms)}</body>'


def model_of(pile, cone):
    """MJCF, with everything but the cone, of CONES, as MuJoCo ships it: Newton's method,
    and sparse matrices where there is much."""
    return MODEL.format(
        cone=cone,
        step=f"{pile['step']:.17g}", rows=most_rows(pile), stack=STACK,
        mu=f"{pile['friction_coefficient'].max(initial=0):.17g}",
        static="\n".join(_geom(kind, *rest) for of, kind, *rest in pile["geoms"] if of < 0),
        bodies="\n".join(_body(pile, body) for body in range(len(pile["position"]))))


def start_velocity(pile):
    """MuJoCo's velocities at the start of the step: the free ones less h g; what gyroscopic forces gave stays in them."""
    start = pile["free_velocity"].copy()
    start[:, :3] -= pile["step"] * GRAVITY_M_PER_S2
    for velocity, orientation in zip(start, pile["orientation"]):
        velocity[3:] = rotation_matrix(orientation).T @ velocity[3:]
    return text_of(start)


def world_velocity(pile, qvel):
    """(n, 6) Velocities of MuJoCo, whose angular ones are in the body's own frame, as ours."""
    velocity = numpy.array(qvel).reshape(-1, 6)
    for body, orientation in enumerate(pile["orientation"]):
        velocity[body, 3:] = rotation_matrix(orientation) @ velocity[body, 3:]
    return velocity
