"""The rungs of the stability ladder (campaign `ladder` of cleave sweep), and what rigid bodies on springs must do on them.

A contact or joint row with compliance C = cfm / h gives way under its share of a force F until the push-out
(erp / h) * depth holds it: with c equal rows, after n steps,

    depth = (cfm F h / c) * (1 - (1 - erp)^n) / erp        (erp = 0: the last factor is n)

which tends to cfm F h / (erp c). This sag belongs to the problem; only what goes beyond it is a solver's error.
Faces overlap by up to 1e-6 m by construction, which is not counted. All closed forms are those of the time stepping
itself (velocities first, then positions with them), not of continuous time, so h may be any size in them.
"""
import dataclasses
import math
import typing

from cleave_scripts.campaigns.spec import load_spec

GRAVITY_M_PER_S2 = 9.81
CONTACTS = 4  # of one shape on another, and on the plane
LINK_M = 0.3  # of ladder_chain
BOB_M = 1 + LINK_M / 2  # height of its last link when it hangs
HEIGHT_LIMIT_M = 1e-3
PENETRATION_LIMIT_M = 1e-2
DRIFT_LIMIT_M = 1e-3
MOVING_DRIFT_LIMIT_M = 5e-2  # links that turn and collide open their joints by themselves
LEANING_SAG_M = 0.05  # of a stack off its axis: on contacts softer than that it slowly leans over
OVERSHOOT = 2  # of a spring that is loaded suddenly, in units of its sag
ENERGY_LIMIT = 1e-9  # times max(1 J, kinetic energy)
TIME_STEPPING = ("dt", "cfm", "erp", "mu")  # of all rungs that do not say them otherwise
NAN = math.nan


@dataclasses.dataclass(frozen=True)
class Expected:
    """What the last step must show; nan where there is no closed form."""

    height_m: float = NAN  # of the last body, sag included
    sag_m: float = NAN  # by which it is below the rigid height
    joint_gap_m: float = NAN  # of the widest joint
    depth_m: float = NAN  # of the deepest contact
    drift_limit_m: float = DRIFT_LIMIT_M
    longest_step_s: float = math.inf  # at which the time stepping is stable, whoever solves the steps


Settings = typing.Dict[str, str]  # options of cleave, the scene among them


@dataclasses.dataclass(frozen=True, eq=False)
class Rung:
    """A series of runs that differ in one option, easiest first."""

    name: str
    parameter: str  # option of cleave
    cells: typing.Dict[str, Settings]  # by value, as text, in the order they are climbed
    expect: typing.Callable[[Settings, int], Expected]
    quick: tuple  # values of the quick ladder
    setup: str  # of a stack: on_axis or off_axis

    @property
    def values(self):
        return tuple(self.cells)

    def settings(self, value):
        return self.cells[value]


def depth_m(force_n, rows, settings, steps):
    erp, cfm, h_s = (float(settings[name]) for name in ("erp", "cfm", "dt"))
    share = steps if erp == 0 else (1 - (1 - erp)**steps) / erp
    return cfm * force_n * h_s / rows * share


def weights_above(masses_kg):
    """The force on the lower side of each body of a pile."""
    return [GRAVITY_M_PER_S2 * sum(masses_kg[i:]) for i in range(len(masses_kg))]


def stack(masses_kg, settings, steps):
    if int(settings.get("contact-cap", "8")) < CONTACTS:
        return Expected()  # what is left of an interface does not carry a box
    copies = int(settings.get("copies", "1"))
    depths = [
        depth_m(force, CONTACTS * (copies if i == 0 else copies**2), settings, steps)
        for i, force in enumerate(weights_above(masses_kg))
    ]
    sag_m = sum(depths)
    leans = float(settings.get("offset-m", "0")) > 0 and sag_m > LEANING_SAG_M
    height_m = NAN if leans else len(masses_kg) - 0.5 - sag_m
    return Expected(height_m=height_m, sag_m=sag_m, depth_m=max(depths))


def equal_stack(settings, steps):
    return stack([1.0] * int(settings["boxes"]), settings, steps)


def heavy_top(settings, steps):
    return stack([1.0] * int(settings["boxes"]) + [float(settings["mass-ratio"])], settings, steps)


def alternating(settings, steps):
    ratio = float(settings["mass-ratio"])
    return stack([ratio if i % 2 else 1.0 for i in range(int(settings["boxes"]))], settings, steps)


def incline(settings, steps):
    """Holds where mu >= tan(angle), else slides by h^2 a n (n + 1) / 2."""
    angle, mu = math.radians(float(settings["angle"])), float(settings["mu"])
    pull = max(0.0, GRAVITY_M_PER_S2 * (math.sin(angle) - mu * math.cos(angle)))
    way_m = float(settings["dt"])**2 * pull * steps * (steps + 1) / 2
    depth = depth_m(GRAVITY_M_PER_S2 * math.cos(angle), CONTACTS, settings, steps)
    return Expected(height_m=(0.5 - depth) * math.cos(angle) - way_m * math.sin(angle),
                    sag_m=depth * math.cos(angle),
                    depth_m=depth)


def hanging_chain(settings, steps):
    links = int(settings["links"])
    masses = [1.0] * (links - 1) + [float(settings["mass-ratio"])]
    gaps = [depth_m(force, 1, settings, steps) for force in weights_above(masses)]
    return Expected(height_m=BOB_M - sum(gaps), sag_m=sum(gaps), joint_gap_m=max(gaps))


def longest_step_s(settings):
    """Rods of mass m and length l on joints, taut under T, swing against each other at up to sqrt(12 T / (m l)): their
    highest mode is a zigzag. The force that drives them back is the joints' at the positions of the step's start, so
    symplectic Euler carries it up to h omega = 2. T is that of the top joint at rest."""
    tension_n = GRAVITY_M_PER_S2 * (int(settings["links"]) - 1 + float(settings["mass-ratio"]))
    return math.sqrt(LINK_M / (3 * tension_n))


def swinging_chain(settings, _steps):
    return Expected(joint_gap_m=0, drift_limit_m=MOVING_DRIFT_LIMIT_M, longest_step_s=longest_step_s(settings))


def moving_joints(_settings, _steps):
    return Expected(joint_gap_m=0, drift_limit_m=MOVING_DRIFT_LIMIT_M)


def free_fall(settings, steps):
    return Expected(height_m=-GRAVITY_M_PER_S2 * float(settings["dt"])**2 * steps * (steps + 1) / 2, sag_m=0)


def no_closed_form(_settings, _steps):
    return Expected()


QUICK_CFM = ("1e-2", "1e-5", "1e-8", "1e-12", "1e-14", "0")
QUICK_RATIO = ("1", "100", "1e4", "1e6")

# What must come out, and the values of the quick ladder. A stack is climbed in two set-ups,
# the second under this name with _off_axis.
STACKS = {
    "heavy_top": (heavy_top, QUICK_RATIO),
    "alternating": (alternating, QUICK_RATIO),
    "stiffness": (equal_stack, QUICK_CFM),
    "push_out": (equal_stack, ("0", "0.2", "0.8")),
    "time_step": (equal_stack, ("1e-4", "1e-3", repr(1 / 60), repr(1 / 30))),
    "contact_cap": (equal_stack, ("1", "2", "4", "8")),
    "duplicates": (equal_stack, ("1", "2", "3")),
    "stack": (equal_stack, ("5", "10", "20", "50")),
}
OFF_AXIS = "_off_axis"
OTHERS = {
    "chain_bob": (hanging_chain, QUICK_RATIO),
    "chain_swing": (swinging_chain, QUICK_RATIO),
    "chain_swing_short_step": (swinging_chain, QUICK_RATIO),
    "chain_links": (hanging_chain, ("10", "100", "300")),
    "stiff_pile": (no_closed_form, QUICK_CFM),
    "friction": (incline, ("0", "0.2", "0.5", "10", "1e6")),
    "loop": (moving_joints, ("3", "4", "8", "16")),
    "rigid_loop": (moving_joints, ("3", "4", "8")),
    "no_contact": (free_fall, ("1", "10")),
}


def setup_of(name):
    if name in OTHERS:
        return "-"
    return "off_axis" if name.endswith(OFF_AXIS) else "on_axis"


def rung_of(rule):
    """(name of its rung, parameter, its values of it) of an include with the label RUNG/{PARAMETER}/..."""
    name, parameter = rule["label"].split("/")[:2]
    parameter = parameter.strip("{}")
    values = rule[parameter]
    return name, parameter, values if isinstance(values, list) else [values]


def read_rungs(spec):
    """Those of a campaign; several of its includes may be of one rung."""
    common = {key: value for key, value in spec.items() if isinstance(value, str) and key in TIME_STEPPING}
    found = {}
    for rule in spec["include"]:
        name, parameter, values = rung_of(rule)
        options = {key: value for key, value in rule.items() if key != "label"}
        settings = found.setdefault((name, parameter), {})
        settings |= {value: {**common, **options, parameter: value} for value in values}
    return tuple(
        Rung(name, parameter, settings, *(OTHERS | STACKS)[name.removesuffix(OFF_AXIS)], setup_of(name))
        for (name, parameter), settings in found.items())


RUNGS = read_rungs(load_spec("ladder"))
