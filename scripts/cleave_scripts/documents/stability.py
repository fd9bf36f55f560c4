"""The stability ladder and the interior point at extreme stiffness."""
from cleave_scripts.documents.stored import need
from cleave_scripts.ladder.climbers import OWN_BOUNDS
from cleave_scripts.measurements import extremes_steps
from cleave_scripts.table import text

QUICK = ("ladder/ladder.csv", "scripts/ladder")
FULL = ("ladder/ladder_full_exact.csv", "scripts/ladder --full --solver exact")
EXTREMES = ("extremes.csv", "scripts/extremes --seeds 1")
SETUPS = {"on_axis": "`on_axis`", "off_axis": "`off_axis`", "-": "other"}  # column `setup`: title


def _ladder_line(rows, solver):
    cells = []
    for column in ("status", "physics"):
        for setup in SETUPS:
            mine = [row for row in rows if row["solver"] == solver and row["setup"] == setup]
            is_judged = mine and not (solver in OWN_BOUNDS and column == "status")
            cells.append(f"{sum(row[column] == 'ok' for row in mine)} of {len(mine)}" if is_judged else "-")
    return [f"`{solver}`", *cells]


def _wrong_motion(rows):
    """On which values the motion of `exact` is not right, and why."""
    wrong = {}
    for row in rows:
        if row["solver"] == "exact" and row["physics"] != "ok":
            wrong.setdefault((row["rung"], row["parameter"], row["physics"]), []).append(row["value"])
    if not wrong:
        return "With `exact` the motion is right on every value."
    told = [f"`{rung}` at {parameter} {text.listed(values)} (`{physics}`)"
            for (rung, parameter, physics), values in wrong.items()]
    unstable = any(physics == "step_too_long" for _, _, physics in wrong)
    return (f"With `exact` the motion is not right on {text.listed(told)}." +
            (" Where `physics` is `step_too_long`, the time stepping itself is unstable, whoever solves." if unstable else ""))


def ladder(stored):
    rows = need(stored.table(*QUICK), "the ladder", "setup")
    solvers = list(dict.fromkeys(row["solver"] for row in rows))
    header = ["solver", *(f"{what}: {title}" for what in ("exact in every step", "motion right")
                          for title in SETUPS.values())]
    parts = [f"{len({row['rung'] for row in rows})} rungs, from the quick values of `scripts/ladder`, "
             f"{stored.origin(QUICK[0])}; values out of all, on stacks straight above each other (`on_axis`), on stacks "
             "off their axis (`off_axis`) and on the other rungs:",
             text.table(header, [_ladder_line(rows, solver) for solver in solvers]), _wrong_motion(rows)]
    for solver in OWN_BOUNDS:
        if solver in solvers:
            parts.append(f"Whether `{solver}` is exact is not judged: the judge keeps the friction bounds of the problem, and "
                         "ODE's pyramid finds its own.")
    return "\n\n".join(parts)


def ladder_full(stored):
    rows = need(stored.table(*FULL), "the full ladder")
    exact, right = ([row for row in rows if row[column] == "ok"] for column in ("status", "physics"))
    words = f"all {len(rows)}" if len(exact) == len(rows) else f"{len(exact)} of {len(rows)}"
    lines = [f"Over the full ladder `exact` solves {words} values exactly in every step, and on {len(right)} the motion "
             "is right by the limits of `physics`."]
    heavy = [row for row in rows if row["rung"] == "heavy_top"]
    if heavy:
        last = max(heavy, key=lambda row: float(row["value"]))
        steps, ratio = int(last["steps"]), last["value"]
        lines.append(
            f"Five boxes of 1 kg under one of {ratio} kg (`cleave run --scene ladder_heavy_top --mass-ratio {ratio} "
            f"--cfm 1e-10 --steps {steps} --solver exact --out out/heavy_top`) stand, after {steps / 60:.0f} s, within "
            f"{text.number(1000 * float(last['height_error_m']), 2)} mm of the closed form, in which the compliance "
            f"lets them sag {text.number(1000 * float(last['sag_m']), 2)} mm.")
    return "\n".join(lines)


def _not_solved(rows):
    return [row for row in rows if row["status"] != "ok"]


def extremes(stored):
    rows = need(stored.table(*EXTREMES), "the extremes")
    return (f"`{EXTREMES[1]}`, {stored.origin(EXTREMES[0])}. Cells are mean / most factorisations of a step.\n\n" +
            extremes_steps.markdown(extremes_steps.cells(rows)) + "\n\n" + _most(rows))


def _most(rows):
    soft = [row for row in rows if float(row["cfm"]) > 0]
    failed = _not_solved(rows)
    parts = ["All steps were solved" if not failed else f"{len(failed)} of {len(rows)} steps were not solved"]
    for low, high, limit in ((0, 1e3, 40), (1e3, 1e6, 70)):
        counts = [int(row["factorizations"]) for row in soft if low < float(row["mass_ratio"]) <= high]
        if counts:
            between = f"above {low:.0e}, up to {high:.0e}" if low else f"up to {high:.0e}"
            parts.append(f"at most {max(counts)} factorisations (asked: {limit}) at mass ratios {between}".replace("e+0", "e"))
    rigid = [int(row["factorizations"]) for row in rows if float(row["cfm"]) == 0]
    if rigid:
        parts.append(f"at most {max(rigid)} without any compliance, when proximal steps may have to follow")
    return f"{'; '.join(parts)}."


def extremes_sentence(stored):
    rows = need(stored.table(*EXTREMES), "the extremes")
    failed = _not_solved(rows)
    words = "fails on none" if not failed else f"fails on {len(failed)}"
    most = max(int(row["factorizations"]) for row in rows if float(row["cfm"]) > 0)
    return (f"Over {len(rows)} steps of piles, towers and chains with mass ratios up to 1e6 and compliance down to none "
            f"the interior point {words}, in at most {most} factorisations while there is any compliance "
            "([solver/README.md](solver/README.md)).")


BLOCKS = {"ladder": ladder, "ladder_full": ladder_full, "extremes": extremes, "extremes_sentence": extremes_sentence}
