"""Coulomb's law as solved here and by Siconos: the same recorded steps, from the same warm start,
both answers judged by both."""
import csv
import math

from cleave_scripts.results.command import say
from cleave_scripts.results.names import base_name
from cleave_scripts.results.programs import record, replay, run
from cleave_scripts.table import text

SCENES = {  # small enough for Gauss-Seidel to end
    "chain_drop": ("--links", 20),
    "log_tower": ("--layers", 5),
    "rock_pile": ("--bodies", 40),
    "large_rock_pile": ("--bodies", 40),
    "silo": ("--bodies", 27),
    "ladder_stack": (),
    "ladder_heavy_top": (),
    "ladder_alternating": (),
    "ladder_incline": ("--boxes", 5),
}
LEFT_OUT = ("crane", "mixed_site")  # with motors, whose rows have bounds: cleave_peers refuses to give them to Siconos
STEPS = (60, 200)  # in motion, and later
CFMS, MUS = ("1e-5", "1e-7", "1e-9"), ("0.3", "0.5", "0.8")
OURS = "exact"
# Iterations after which each was seen to go on for nothing.
THEIRS = ("siconos-nsgs@peer-iterations=50000", "siconos-newton@peer-iterations=3000")
TOLERANCE = 1e-10  # that Siconos is run to, in its own error
OUR_ERROR_LIMIT, THEIR_RESIDUAL_LIMIT_M_PER_S, VELOCITY_LIMIT_M_PER_S = 1e-8, 1e-6, 1e-6
MU_LIMIT = 0.5  # up to which velocities have to agree
COLUMNS = ("scene", "bodies", "step", "cfm", "mu", "contacts", "rows", "rows_bilateral", "status", "residual_m_per_s",
           "siconos_error", "peer", "peer_status", "peer_iterations", "peer_residual_m_per_s", "peer_siconos_error",
           "velocity_difference_m_per_s")
PROBLEM = ("scene", "step", "cfm", "mu")


def measure(program, peers, scratch, scenes=SCENES):
    """A row a recorded step with contacts and solver of Siconos."""
    for scene in scenes:
        for cfm in CFMS:
            say(f"{scene}, cfm {cfm}")
            for mu in MUS:
                files = record(program, scratch / "steps", scene, STEPS, *SCENES[scene], "--friction", "coulomb",
                               "--advance", "exact", "--cfm", cfm, "--mu", mu, all_ok=False)
                for row in _solved(peers, scratch / "solved", files):
                    yield {**row, "cfm": cfm, "mu": mu}


def _solved(peers, directory, files):
    solvers = (OURS, *THEIRS)
    rows = replay(peers, directory, files, "--solver", ",".join(solvers), "--repeats", 1, "--peer-tolerance", TOLERANCE,
                  "--write-solutions")
    for number, file in enumerate(files):
        ours, *theirs = rows[len(solvers) * number:len(solvers) * (number + 1)]
        if ours.integer("contacts") == 0:
            continue
        errors = _errors(peers, directory / file.name)
        our_error = errors.get(OURS, {}).get("siconos_error", "nan")
        for peer in theirs:
            found = errors.get(peer["solver"], {})
            yield {**{name: ours[name] for name in COLUMNS if name in ours}, "siconos_error": our_error,
                   "peer": base_name(peer["solver"]), "peer_status": peer["status"], "peer_iterations": peer["iterations"],
                   "peer_residual_m_per_s": found.get("residual_m_per_s", "nan"),
                   "peer_siconos_error": found.get("siconos_error", "nan"),
                   "velocity_difference_m_per_s": found.get("velocity_difference_m_per_s", "nan") if OURS in errors else "nan"}


def _errors(peers, file):
    """{solver: what Siconos says of its stored solution}; ours, where it stored one, is the first by name,
    which velocities are compared with."""
    told = file.with_suffix(".csv")
    with open(told, "w", encoding="utf-8") as out:
        run([peers, "siconos-error", file], stdout=out)
    with open(told, newline="", encoding="utf-8") as read:
        return {row["solver"]: row for row in csv.DictReader(read)}


def reached(row):
    """Whether Siconos came to its tolerance."""
    return float(row["peer_siconos_error"]) <= TOLERANCE


def both(row):
    return row["status"] == "ok" and reached(row)


def beyond(row):
    """What of a row is not as it should be, in words."""
    if row["status"] != "ok":
        yield "not solved by us"
    elif float(row["siconos_error"]) > OUR_ERROR_LIMIT:
        yield "our error"
    if not reached(row):
        yield "not solved by them"
    elif float(row["peer_residual_m_per_s"]) > THEIR_RESIDUAL_LIMIT_M_PER_S:
        yield "their residual"
    if both(row) and float(row["velocity_difference_m_per_s"]) > VELOCITY_LIMIT_M_PER_S:
        yield "velocities"


def problems(rows):
    """{scene, step, cfm, mu: its rows}"""
    found = {}
    for row in rows:
        found.setdefault(tuple(str(row[name]) for name in PROBLEM), []).append(row)
    return found


def _largest(rows, column):
    return text.number(max((float(row[column]) for row in rows), default=math.nan))


def _has_velocity_limit(row):
    return float(row["mu"]) <= MU_LIMIT


def _scene_lines(rows):
    for scene, cfm in dict.fromkeys((row["scene"], row["cfm"]) for row in rows):
        mine = [row for row in rows if (row["scene"], row["cfm"]) == (scene, cfm)]
        count = len(problems(mine))
        solved = [row for row in mine if row["status"] == "ok"]
        contacts = [int(row["contacts"]) for row in mine]
        compared = [row for row in mine if both(row)]
        yield [scene.replace("_", " "), cfm, f"{min(contacts)} to {max(contacts)}", f"{len(problems(solved))} of {count}",
               _largest(solved, "siconos_error"),
               *(f"{sum(row['peer'] == base_name(peer) and reached(row) for row in mine)} of {count}" for peer in THEIRS),
               _largest(filter(reached, mine), "peer_residual_m_per_s"), len(compared),
               _largest(filter(_has_velocity_limit, compared), "velocity_difference_m_per_s"),
               _largest((row for row in compared if not _has_velocity_limit(row)), "velocity_difference_m_per_s")]


SCENE_HEADER = ("scene", "cfm", "contacts", "solved by us", "largest error of ours", "by their Gauss-Seidel", "by their Newton",
                "largest residual of theirs, m/s", "pairs compared", f"velocity difference, mu <= {MU_LIMIT}",
                f"mu > {MU_LIMIT}")


def scene_table(rows):
    return text.table(SCENE_HEADER, _scene_lines(rows))


def counts(rows):
    """What was found against the limits, in a few sentences."""
    of_problems = problems(rows)
    first = [mine[0] for mine in of_problems.values()]
    ours = [row for row in first if row["status"] == "ok"]
    theirs = [row for row in rows if reached(row)]
    compared = [row for row in rows if both(row) and _has_velocity_limit(row)]
    rough = [row for row in rows if both(row) and not _has_velocity_limit(row)]
    only_theirs = sum(mine[0]["status"] != "ok" and any(map(reached, mine)) for mine in of_problems.values())
    only_ours = sum(mine[0]["status"] == "ok" and not any(map(reached, mine)) for mine in of_problems.values())

    def within(of, column, limit):
        return f"{sum(float(row[column]) <= limit for row in of)} of {len(of)}"

    return (f"{len(first)} problems. Solved by us: {len(ours)}; of these Siconos's error is at most "
            f"{text.power(OUR_ERROR_LIMIT)} on {within(ours, 'siconos_error', OUR_ERROR_LIMIT)}, of all on "
            f"{within(first, 'siconos_error', OUR_ERROR_LIMIT)}. Siconos's solvers came to {text.power(TOLERANCE)} "
            f"{len(theirs)} of {len(rows)} times; of these our residual is at most {text.power(THEIR_RESIDUAL_LIMIT_M_PER_S)} "
            f"m/s on {within(theirs, 'peer_residual_m_per_s', THEIR_RESIDUAL_LIMIT_M_PER_S)}. Where both were "
            f"solved, no velocity differs by more than {text.power(VELOCITY_LIMIT_M_PER_S)} m/s or rad/s on "
            f"{within(compared, 'velocity_difference_m_per_s', VELOCITY_LIMIT_M_PER_S)} with mu <= {MU_LIMIT} and on "
            f"{within(rough, 'velocity_difference_m_per_s', VELOCITY_LIMIT_M_PER_S)} with a larger one. Solved by a solver of "
            f"Siconos and not by us: {only_theirs} problems; by us alone: {only_ours}.")


BEYOND_HEADER = (*PROBLEM, "peer", "what", "our residual, m/s", "our error", "their residual, m/s", "their error",
                 "velocity difference")
_MEASURES = ("residual_m_per_s", "siconos_error", "peer_residual_m_per_s", "peer_siconos_error", "velocity_difference_m_per_s")


def beyond_table(rows):
    """Every row that is beyond a limit, or that one side did not solve."""
    found = [[*(row[name] for name in (*PROBLEM, "peer")), ", ".join(words),
              *(text.number(float(row[name])) for name in _MEASURES)] for row in rows if (words := list(beyond(row)))]
    return text.table(BEYOND_HEADER, found)
