"""What the rows of friction_bounds.csv come to: how many sweeps halve the mismatch of the box's bounds, and what they cost."""
import dataclasses

from cleave_scripts.measurements.friction_bounds import CONVERGED, DEFAULT_SWEEPS, FROZEN
from cleave_scripts.results.command_line import counted
from cleave_scripts.table import text

HALF, CHEAP = 0.5, 0.05  # of the mismatch with DEFAULT_SWEEPS; of t_s: at most


@dataclasses.dataclass(frozen=True)
class Bounds:
    """Of a scene."""
    scene: str
    mismatches: dict  # by sweeps, in their order
    carried: float  # mismatch of the converged impulses of the step before
    unsettled: int  # steps in which they did not converge
    t_s_ms: float
    sweep_ms: float  # these two with DEFAULT_SWEEPS

    def cost(self, sweeps):
        """Of the sweeps beyond the default, as a share of t_s."""
        return (sweeps - DEFAULT_SWEEPS) * self.sweep_ms / self.t_s_ms

    def halves(self, mismatch):
        return mismatch <= HALF * self.mismatches[DEFAULT_SWEEPS]

    @property
    def halving(self):
        """The fewest sweeps that halve it; None where none do."""
        return next((sweeps for sweeps, mismatch in self.mismatches.items() if self.halves(mismatch)), None)


def bounds_of(rows):
    return [_of_scene(scene, [row for row in rows if row["scene"] == scene])
            for scene in dict.fromkeys(row["scene"] for row in rows)]


def _of_scene(scene, rows):
    frozen = {int(row["bound_sweeps"]): row for row in rows if row["start"] == FROZEN}
    carried, = (row for row in rows if row["start"] == CONVERGED)
    return Bounds(scene=scene.replace("_", " "),
                  mismatches={sweeps: float(frozen[sweeps]["bound_mismatch"]) for sweeps in sorted(frozen)},
                  carried=float(carried["bound_mismatch"]), unsettled=int(carried["unsettled"]),
                  **{name: float(frozen[DEFAULT_SWEEPS][name]) for name in ("t_s_ms", "sweep_ms")})


def _sweeps(count):
    return counted(count, "sweep")


def _line(bounds):
    cells = [text.number(100 * mismatch) + (f" ({text.number(100 * bounds.cost(sweeps))})" if sweeps != DEFAULT_SWEEPS else "")
             for sweeps, mismatch in bounds.mismatches.items()]
    return [bounds.scene, text.number(bounds.t_s_ms), text.number(bounds.sweep_ms),
            text.number(CHEAP * bounds.t_s_ms / bounds.sweep_ms), *cells,
            f"{text.number(100 * bounds.carried)} ({bounds.unsettled})"]


def table(rows):
    scenes = bounds_of(rows)
    header = ["scene", "t_s, ms", "a sweep, ms", f"sweeps in {text.percent(CHEAP)} of t_s",
              *map(_sweeps, scenes[0].mismatches), "converged"]
    return text.table(header, [_line(bounds) for bounds in scenes])


def verdict(rows):
    scenes = bounds_of(rows)
    halved = [bounds for bounds in scenes if bounds.halving is not None]
    cheap = [f"{bounds.scene} by {_sweeps(bounds.halving)}" for bounds in halved if bounds.cost(bounds.halving) <= CHEAP]
    dear = [f"{text.number(100 * bounds.cost(bounds.halving))} % on {bounds.scene} ({_sweeps(bounds.halving)})"
            for bounds in halved if bounds.cost(bounds.halving) > CHEAP]
    never = [bounds.scene for bounds in scenes if bounds.halving is None]
    carried = [bounds.scene for bounds in scenes if bounds.halves(bounds.carried)]
    return " ".join([f"Halved at no more than {text.percent(CHEAP)} of t_s: on {text.listed(cheap)}.",
                     *[f"What halves it costs {text.listed(dear)}."] * bool(dear),
                     *[f"No number of sweeps here halves it on {text.listed(never)}."] * bool(never),
                     f"The converged impulses of the step before, without a sweep, halve it on {text.listed(carried)}."])
