"""Two closed forms of friction, and what the models do: from which coefficient on a block holds on a slope, by the angle of the
downhill direction against the axes of the friction rows; and how far a block that slides on the level rises in a step.

A slope of the incline a holds a block from mu = tan a on, under the box from tan a times the greater of |cos|, |sin| of that
angle on: its two rows have bounds of their own. The convex cone parts what slides at mu times its speed v after the step,
h mu v = h mu (v0 - mu g h) / (1 + mu^2); the box and Coulomb's law lift nothing.
"""
import itertools
import math

import numpy

from cleave_scripts.measurements.friction_of_models import MODELS
from cleave_scripts.results.command import say
from cleave_scripts.results.programs import run
from cleave_scripts.results.steps import load_steps

COLUMNS = ("form", "friction", "angle_deg", "mu", "closed_form_mu", "speed_m_per_s", "lift_m", "closed_form_lift_m")
HOLDS, LIFTS = "holds", "lifts"
INCLINE_DEG, ANGLES_DEG = 20, (0, 15, 30, 45)
SPEEDS_M_PER_S, SLIDING_MU = (0.5, 1, 2, 4), 0.2
GRAVITY_M_PER_S2, STEP_S = 9.81, 1 / 60
HALVINGS = 12  # of the interval in which the coefficient lies
HALF_M, OVERLAP_M = 0.05, 1e-4  # of the block's height; at the start
STEPS, SETTLED, SLID_M = 120, 10, 1e-4  # a block has slid that has gone down so far since it settled
STIFF = ("--cfm", "1e-9")  # compliance lets what holds creep


def normal_of(angle_deg):
    """Of a plane down which a block slides at this angle to the first tangent of its contacts, which ODE lays in the plane
    x = 0: the heading of the slope is found by halving."""
    low, high = 0, math.pi / 2
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if _angle_at(middle) > math.radians(angle_deg) else (low, middle)
    return _normal(low)


def _normal(heading):
    incline = math.radians(INCLINE_DEG)
    return numpy.array([math.sin(incline) * math.cos(heading), math.sin(incline) * math.sin(heading), math.cos(incline)])


def _angle_at(heading):
    """Falls from a right angle, where the slope runs along x, to 0."""
    normal = _normal(heading)
    first = numpy.array([0, -normal[2], normal[1]]) / math.hypot(normal[1], normal[2])
    downhill = normal[2] * normal - [0, 0, 1]
    return math.atan2(abs(downhill @ numpy.cross(normal, first)), abs(downhill @ first))


def world(normal, speed_m_per_s=0):
    """Text of a scene file: a flat block on a plane."""
    return f"""[[plane]]
normal = {list(map(float, normal))}
offset_m = 0
[[body]]
shape = "box"
edges_m = [1, 1, {2 * HALF_M}]
mass_kg = 10
position_m = {[float(x * (HALF_M - OVERLAP_M)) for x in normal]}
along = {list(map(float, normal))}
velocity_m_per_s = [{speed_m_per_s}, 0, 0]
"""


def closed_form_mu(friction, angle_deg):
    angle, steep = math.radians(angle_deg), math.tan(math.radians(INCLINE_DEG))
    return steep * max(math.cos(angle), math.sin(angle)) if friction.startswith("box") else steep


def closed_form_lift_m(friction, speed_m_per_s):
    if friction != "cone":
        return 0
    return STEP_S * SLIDING_MU * (speed_m_per_s - SLIDING_MU * GRAVITY_M_PER_S2 * STEP_S) / (1 + SLIDING_MU**2)


def heights_m(program, scratch, text, friction, mu, *options):
    """Of the block after each step."""
    (scratch / "world.toml").write_text(text)
    run([program, "run", "--scene", "file@path=world.toml", "--solver", "exact", "--repeats", 1, "--friction", friction,
         "--mu", mu, *options, "--out", scratch / "run", "--force"], cwd=scratch)
    return [row.number("last_body_z_m") for row in load_steps(scratch / "run" / "steps.csv")[0]]


def holding_mu(program, scratch, friction, angle_deg):
    text, low, high = world(normal_of(angle_deg)), 0, 2 * math.tan(math.radians(INCLINE_DEG))
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        heights = heights_m(program, scratch, text, friction, middle, *STIFF, "--steps", STEPS)
        low, high = (middle, high) if heights[SETTLED] - heights[-1] > SLID_M else (low, middle)
    return (low + high) / 2


def lift_m(program, scratch, friction, speed_m_per_s):
    """Beyond what pushes the overlap at the start out of a block that rests."""
    sliding, resting = (heights_m(program, scratch, world((0, 0, 1), speed), friction, SLIDING_MU, "--steps", 1)[0]
                        for speed in (speed_m_per_s, 0))
    return sliding - resting


def form_rows(program, scratch):
    for friction, angle_deg in itertools.product(MODELS, ANGLES_DEG):
        say(f"a slope at {angle_deg} degrees to the axes under {friction}")
        yield {"form": HOLDS, "friction": friction, "angle_deg": angle_deg, "speed_m_per_s": "-", "lift_m": "-",
               "mu": holding_mu(program, scratch, friction, angle_deg),
               "closed_form_mu": closed_form_mu(friction, angle_deg), "closed_form_lift_m": "-"}
    for friction, speed in itertools.product(MODELS, SPEEDS_M_PER_S):
        yield {"form": LIFTS, "friction": friction, "angle_deg": "-", "speed_m_per_s": speed, "mu": SLIDING_MU,
               "closed_form_mu": "-", "lift_m": lift_m(program, scratch, friction, speed),
               "closed_form_lift_m": closed_form_lift_m(friction, speed)}
