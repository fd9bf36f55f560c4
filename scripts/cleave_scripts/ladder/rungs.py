"""The rungs of the stability ladder, and what rigid bodies on springs must do on them.

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


Settings = typing.Dict[str, str]  # options of cleave, those of the scene among them


@dataclasses.dataclass(frozen=True, eq=False)
class Rung:
    """A series of runs that differ in one option, easiest first."""

    name: str
    parameter: str  # option of cleave
    values: tuple  # as text, in the order they are climbed
    quick: tuple  # those of the quick ladder
    scene: str
    fixed: Settings
    expect: typing.Callable[[Settings, int], Expected]
    setup: str = "-"  # of a stack: on_axis or off_axis
    derived: typing.Callable[[Settings], Settings] = lambda settings: {}  # options that follow from the value

    def settings(self, value):
        settings = {
            "dt": repr(1 / 60),
            "cfm": "1e-5",
            "erp": "0.2",
            "mu": "0.5",
            **self.fixed, self.parameter: value
        }
        return {**settings, **self.derived(settings)}


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


def half_the_longest_step(settings):
    return {"dt": repr(min(float(settings["dt"]), longest_step_s(settings) / 2))}


def swinging_chain(settings, _steps):
    return Expected(joint_gap_m=0, drift_limit_m=MOVING_DRIFT_LIMIT_M, longest_step_s=longest_step_s(settings))


def moving_joints(_settings, _steps):
    return Expected(joint_gap_m=0, drift_limit_m=MOVING_DRIFT_LIMIT_M)


def free_fall(settings, steps):
    return Expected(height_m=-GRAVITY_M_PER_S2 * float(settings["dt"])**2 * steps * (steps + 1) / 2, sag_m=0)


def no_closed_form(_settings, _steps):
    return Expected()


CFM = ("1e-2", "1e-3", "1e-4", "1e-5", "1e-6", "1e-8", "1e-10", "1e-12", "1e-14", "0")
QUICK_CFM = ("1e-2", "1e-5", "1e-8", "1e-12", "1e-14", "0")
RATIO = ("1", "10", "100", "1e3", "1e4", "1e5", "1e6")
QUICK_RATIO = ("1", "100", "1e4", "1e6")
STIFF = {"cfm": "1e-10"}
SWING = {"links": "10", "angle": "30", **STIFF}

# A box that slides at 3 m/s moves by more than the default tolerance in a step. Its contacts would be taken for new
# ones, and the friction bounds, predicted by a few sweeps from zero, would come out 2 to 5 % too large in every step.
KEEP_CONTACTS = {"match-tolerance": "0.45"}

# A stack is climbed in two set-ups. On its axis, as the scenes build it by default, all boxes stand straight above
# each other and overlap by less than the surface layer, so that no contact is pushed out: in a stack at rest all rows
# between boxes then ask for exactly the velocity they have, and rows of one face carry exactly the same. The answer is
# none the worse for such ties, but dWorldStep gives up where a pivot meets one (scenarios/README.md). Off the axis
# there are none: the boxes stand 1 mm beside it, each in another direction, and overlap by more than the layer.
OFF_AXIS = {"overlap-m": "1e-6", "layer-m": "5e-7", "offset-m": "1e-3"}

STACKS = (
    Rung("heavy_top", "mass-ratio", RATIO, QUICK_RATIO, "ladder_heavy_top", {
        "boxes": "5",
        **STIFF
    }, heavy_top),
    Rung("alternating", "mass-ratio", RATIO, QUICK_RATIO, "ladder_alternating", {
        "boxes": "10",
        **STIFF
    }, alternating),
    Rung("stiffness", "cfm", CFM, QUICK_CFM, "ladder_stack", {"boxes": "10"}, equal_stack),
    Rung("push_out", "erp", ("0", "0.1", "0.2", "0.4", "0.6", "0.8"), ("0", "0.2", "0.8"), "ladder_stack",
         {"boxes": "10"}, equal_stack),
    Rung("time_step", "dt", ("1e-4", "1e-3", "0.005", "0.01", repr(1 / 60), repr(1 / 30)),
         ("1e-4", "1e-3", repr(1 / 60), repr(1 / 30)), "ladder_stack", {"boxes": "10"}, equal_stack),
    Rung("contact_cap", "contact-cap", tuple("12345678"), tuple("1248"), "ladder_stack", {"boxes": "5"},
         equal_stack),
    Rung("duplicates", "copies", tuple("1234"), tuple("123"), "ladder_stack", {"boxes": "5"}, equal_stack),
    Rung("stack", "boxes", ("5", "10", "15", "20", "30", "40", "50"), ("5", "10", "20", "50"), "ladder_stack",
         {}, equal_stack),
)


def both_setups(rung):
    off_axis = {**rung.fixed, **OFF_AXIS}
    return (dataclasses.replace(rung, setup="on_axis"),
            dataclasses.replace(rung, name=f"{rung.name}_off_axis", fixed=off_axis, setup="off_axis"))


OTHERS = (
    Rung("chain_bob", "mass-ratio", RATIO, QUICK_RATIO, "ladder_chain", {
        "links": "10",
        **STIFF
    }, hanging_chain),
    Rung("chain_swing", "mass-ratio", RATIO, QUICK_RATIO, "ladder_chain", SWING, swinging_chain),
    Rung("chain_swing_short_step",
         "mass-ratio",
         RATIO,
         QUICK_RATIO,
         "ladder_chain",
         SWING,
         swinging_chain,
         derived=half_the_longest_step),
    Rung("chain_links", "links", ("10", "30", "100", "300", "1000", "2000"), ("10", "100", "300"),
         "ladder_chain", {
             "mass-ratio": "1000",
             **STIFF
         }, hanging_chain),
    Rung("stiff_pile", "cfm", CFM, QUICK_CFM, "rock_pile", {"bodies": "20"}, no_closed_form),
    Rung("friction", "mu", ("0", "0.1", "0.2", "0.3", "0.5", "1", "10", "1e3", "1e6"),
         ("0", "0.2", "0.5", "10", "1e6"), "ladder_incline", {
             "angle": "15",
             **KEEP_CONTACTS
         }, incline),
    Rung("loop", "links", ("3", "4", "6", "8", "16", "32"), ("3", "4", "8", "16"), "ladder_loop",
         {"cfm": "1e-9"}, moving_joints),
    Rung("rigid_loop", "links", ("3", "4", "6", "8", "16", "32"), ("3", "4", "8"), "ladder_loop",
         {"cfm": "0"}, moving_joints),
    Rung("no_contact", "boxes", ("1", "10"), ("1", "10"), "ladder_free", {}, free_fall),
)

RUNGS = (*(rung for rung_of_stack in STACKS for rung in both_setups(rung_of_stack)), *OTHERS)
