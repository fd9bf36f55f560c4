"""What the cheaper friction models change, in one step and in a motion, what the others cost,
and Coulomb's law beside Siconos."""
import math
import statistics

from cleave_scripts.documents.stored import need
from cleave_scripts.measurements import bound_ratios, coulomb_beside_siconos as siconos, friction_forms as forms
from cleave_scripts.measurements.friction_bounds import DEFAULT_SWEEPS
from cleave_scripts.measurements.friction_cost import CONE_OPTIONS, LAW_OPTIONS
from cleave_scripts.measurements.friction_of_models import IN_A_STEP, MODELS
from cleave_scripts.measurements.friction_ratios import markdown, waited
from cleave_scripts.table import text

MADE_BY = "scripts/friction_models"
VELOCITIES, MOTION = (("friction_velocities.csv", MADE_BY), ("friction_motion.csv", MADE_BY))
BOUNDS = ("friction_bounds.csv", MADE_BY)
FORMS = ("friction_forms.csv", "scripts/friction_forms")
COST = ("friction_cost.csv", "scripts/friction_cost")
COULOMB = ("coulomb_peers.csv", "scripts/coulomb_peers")


def _of_rms(row):
    return float(row["rms_difference_m_per_s"]) / float(row["rms_velocity_m_per_s"])


def friction_velocities(stored):
    rows = need(stored.table(*VELOCITIES), "friction models in a step", "status_of_law")
    lines = []
    for scene in dict.fromkeys(row["scene"] for row in rows):
        for model in IN_A_STEP:
            mine = [row for row in rows if (row["scene"], row["friction"]) == (scene, model)]
            held = [row for row in mine if (row["status"], row["status_of_law"]) == ("ok", "ok")]
            shares, most = [100 * _of_rms(row) for row in held], [float(row["largest_difference_m_per_s"]) for row in held]
            lines.append([scene.replace("_", " "), model, f"{len(held)} of {len(mine)}",
                          *(text.number(number) if held else "-" for of in (shares, most)
                            for number in ((statistics.median(of), max(of)) if held else (0, 0)))])
    return ("Recorded steps of the scenes, solved by `exact` under `box` and `cone`, and others with the bounds that "
            "`box-converged` ended on where it moved the scene, held against Coulomb's law in the same step, where both were "
            "solved: root mean square over the bodies of the difference of their velocities, as a share of the velocities' "
            f"own, and the largest difference of one body (`{MADE_BY}`; {stored.origin(VELOCITIES[0])}):\n\n" +
            text.table(["scene", "model", "steps", "difference, %, median", "most", "one body, m/s, median", "most"], lines))


def friction_motion(stored):
    rows = need(stored.table(*MOTION), "motions under the friction models", "run_out_m")
    lines = []
    for scene in dict.fromkeys(row["scene"] for row in rows):
        for model in MODELS:
            mine = [row for row in rows if (row["scene"], row["friction"]) == (scene, model)]
            last = mine[-1]
            passes = statistics.fmean(int(row["factorizations"]) for row in mine)
            lines.append([scene.replace("_", " "), model, text.number(float(last["height_m"])),
                          text.number(float(last["run_out_m"])),
                          *(text.number(float(last[name]) / 1000) for name in ("kinetic_energy_j", "potential_energy_j")),
                          text.number(1000 * float(last["max_penetration_m"])), text.number(passes), last["unsolved_steps"]])
    steps = int(rows[-1]["step"]) + 1
    return (f"The scenes after {steps} steps, each moved by `exact` under one model (`{MADE_BY}`; {stored.origin(MOTION[0])}): "
            "height of the highest centre, horizontal distance from where the middle was within which 95 % of the mass lies, "
            "energies, deepest penetration, factorisations of a measured step (mean), and the steps that were not solved "
            "within the limit:\n\n" +
            text.table(["scene", "model", "height, m", "run-out, m", "kinetic energy, kJ", "potential energy, kJ",
                        "penetration, mm", "factorisations", "unsolved steps"], lines))


def friction_cost(stored):
    rows = need(stored.table(*COST), "costs of friction models", "friction_mismatch")
    cones, laws = markdown(rows)
    return (f"Recorded steps, the two models in turn on one thread, medians of {len({row['round'] for row in rows})} "
            f"rounds (`{COST[1]}`; {stored.origin(COST[0])}). {waited(rows)} Rock piles that the "
            f"exact box moves, their steps by `{CONE_OPTIONS[1]}` from zero impulses. {cones}\n\n"
            f"Scenes that Coulomb's law moves, their steps by `{LAW_OPTIONS[1]}` from the impulses of the step before. {laws}")


def friction_bounds(stored):
    rows = need(stored.table(*BOUNDS), "bounds of friction", "sweep_ms")
    return ("How far the bounds of the box are from mu times the normal impulses that the step ends on, % of these "
            "(`bound_mismatch`, median over measured steps), by the Gauss-Seidel sweeps that predict them from the impulses "
            f"of the step before; in brackets what the sweeps beyond {DEFAULT_SWEEPS}, the default, cost, % of t_s of `exact` "
            "on one thread. Each number of sweeps moves the scene its own way, so that chance is in these, too. Last, "
            "without a sweep: mu times the normal impulses of the step before where `box-converged` moves the scene, in "
            f"brackets the measured steps in which bounds did not settle (`{MADE_BY}`; {stored.origin(BOUNDS[0])}):\n\n"
            f"{bound_ratios.table(rows)}\n\n{bound_ratios.verdict(rows)}")


def coulomb_peers(stored):
    rows = need(stored.table(*COULOMB), "Coulomb's law beside Siconos", "peer_siconos_error")
    return (f"`exact` and the solvers of Siconos on the same recorded steps, {text.listed(siconos.MUS)} as "
            f"coefficient of friction, from the same warm start (`{COULOMB[1]}`; {stored.origin(COULOMB[0])}). "
            f"{siconos.counts(rows)}\n\n{siconos.scene_table(rows)}")


def coulomb_beyond(stored):
    rows = need(stored.table(*COULOMB), "Coulomb's law beside Siconos", "peer_siconos_error")
    found = sum(any(siconos.beyond(row)) for row in rows)
    return (f"{found} of {len(rows)} rows, a row a problem and solver of Siconos (`{COULOMB[1]}`; "
            f"{stored.origin(COULOMB[0])}). Left out are {text.listed([f'`{scene}`' for scene in siconos.LEFT_OUT])}: their "
            f"motors are refused.\n\n{siconos.beyond_table(rows)}")


def _of_form(rows, form, friction, name, told):
    """Cells of a model: what was measured, and the closed form in brackets."""
    return [f"{told(float(row[name]))} ({told(float(row[f'closed_form_{name}']))})"
            for row in rows if (row["form"], row["friction"]) == (form, friction)]


def friction_forms(stored):
    rows = need(stored.table(*FORMS), "closed forms of friction", "closed_form_mu")
    holds, lifts = ([row for row in rows if row["form"] == form] for form in (forms.HOLDS, forms.LIFTS))
    models = dict.fromkeys(row["friction"] for row in rows)
    steep = math.tan(math.radians(forms.INCLINE_DEG))
    angles = [f"{angle} degrees" for angle in dict.fromkeys(row["angle_deg"] for row in holds)]
    speeds = [f"{speed} m/s" for speed in dict.fromkeys(row["speed_m_per_s"] for row in lifts)]
    return (f"A flat block on a slope of {forms.INCLINE_DEG} degrees: the coefficient from which on it holds, over the tangent "
            "of the slope, by the angle between downhill and the nearest axis of its friction rows; closed forms in brackets "
            f"(`{FORMS[1]}`; {stored.origin(FORMS[0])}):\n\n" +
            text.table(["", *angles], [[model, *_of_form(holds, forms.HOLDS, model, "mu", lambda mu: f"{mu / steep:.3f}")]
                                       for model in models]) +
            f"\n\nThe same block sliding on the level with a coefficient of {forms.SLIDING_MU}: by how much it rises in a step "
            "of a sixtieth of a second, mm, by its speed before; closed forms in brackets:\n\n" +
            text.table(["", *speeds], [[model, *_of_form(lifts, forms.LIFTS, model, "lift_m", lambda m: f"{1000 * m:.3f}")]
                                       for model in models]))


BLOCKS = {"friction_velocities": friction_velocities, "friction_motion": friction_motion, "friction_cost": friction_cost,
          "friction_bounds": friction_bounds, "friction_forms": friction_forms, "coulomb_peers": coulomb_peers,
          "coulomb_beyond": coulomb_beyond}
