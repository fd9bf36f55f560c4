"""What has to hold in the matrix that scripts/reproduce writes."""
import math
import statistics

from cleave_scripts.results.names import base_name
from cleave_scripts.results.paper import COMBINATIONS, PAPER, load_paper_table1
from cleave_scripts.results.rows import group
from cleave_scripts.results.steps import EXACT_LIMIT

SPREAD_LIMIT_M_PER_S = 1e-8
LEAST_CONTACT_SHARE = 0.2
NEEDED = ("scene", "seed", "step", "partitioner", "refiner", "solver", "kernel", "status", "max_bodies",
          "max_growth", "contacts", "parts", "max_part_bodies_before", "max_part_bodies",
          "interface_rows_before", "interface_rows", "interface_unknowns", "t_pr_ms", "t_s_ms", "t_s_min_ms",
          "t_s_other_ms", "residual_m_per_s", "largest_free_velocity_m_per_s", "velocity_spread_m_per_s",
          "problem_hash", "state_hash")


def names_of(row):
    return row["partitioner"], row["refiner"]


def is_of_paper(row):
    return base_name(row["solver"]) == PAPER["solver"]


def where(row):
    return (f"{row.path}, line {row.line} ({row['scene']} step {row['step']}, {row['partitioner']} "
            f"{row['refiner']})")


# Criteria on one row: what is wrong with it, or None. Comparisons are written so that nan is wrong.


def status_error(row):
    return None if row["status"] == "ok" else f"status {row['status']}"


def residual_error(row):
    residual, speed = row.number("residual_m_per_s"), row.number("largest_free_velocity_m_per_s")
    limit = EXACT_LIMIT * max(1.0, speed)
    good = residual <= limit and math.isfinite(speed)
    return None if good else f"residual {residual:.3g}, limit {limit:.3g} m/s"


def spread_error(row):
    spread = row.number("velocity_spread_m_per_s")
    return None if spread <= SPREAD_LIMIT_M_PER_S else f"spread {spread:.3g} m/s"


def part_size_error(row):
    """Of the paper's combinations; others promise other sizes, or none."""
    if names_of(row) not in COMBINATIONS:
        return None
    most = row.integer("max_bodies")
    may_grow = row["refiner"] in PAPER["may_grow_parts"]
    grown = math.floor((1 + row.number("max_growth")) * most + 1e-9) if may_grow else most
    before, after = row.integer("max_part_bodies_before"), row.integer("max_part_bodies")
    if 1 <= before <= most and 1 <= after <= grown:
        return None
    return f"largest part {before} grown, {after} refined; allowed {most} and {grown}"


def refinement_error(row):
    before, after = row.integer("interface_rows_before"), row.integer("interface_rows")
    good = 0 <= after <= before if row["refiner"] != PAPER["unrefined"] else 0 <= after == before
    return None if good else f"interface rows {before} before refinement, {after} after"


def interface_error(row):
    """Of the paper's solver; the interface of another need not be the cut rows."""
    if not is_of_paper(row):
        return None
    if row["kernel"] != PAPER["kernel"]:
        return f"kernel {row['kernel']}"
    unknowns, rows = row.integer("interface_unknowns"), row.integer("interface_rows")
    return None if 0 <= unknowns <= rows else f"{unknowns} interface unknowns of {rows} interface rows"


def times_error(row):
    least, median, other = (row.number(name) for name in ("t_s_min_ms", "t_s_ms", "t_s_other_ms"))
    partition = row.number("t_pr_ms")
    good = 0 < least <= median < math.inf and other >= -1e-6 * median and 0 <= partition < math.inf
    return None if good else f"t_s least {least}, median {median}, other {other}, t_pr {partition} ms"


# Criteria on all rows: a list of what is wrong.


def missing_scenes(rows, options):
    return [f"no rows of {scene}" for scene in options.scene if scene not in {row["scene"] for row in rows}]


def few_steps(rows, options):
    steps = group(rows, "scene", "step")
    counts = {scene: sum(key[0] == scene for key in steps) for scene, _ in steps}
    return [
        f"{scene}: {count} measured steps" for scene, count in counts.items() if count < options.min_steps
    ]


def wrong_combinations(rows, _):
    """Every step has the paper's combinations and all others that its scene has."""
    errors = []
    for (scene, _), of_scene in group(rows, "scene", "solver").items():
        wanted = {*COMBINATIONS, *map(names_of, of_scene)}
        for (_, step), members in group(of_scene, "seed", "step").items():
            there = set(map(names_of, members))
            if there != wanted or len(members) != len(wanted):
                errors.append(f"{scene} step {step}: {len(members)} rows, {len(there)} of {len(wanted)} combinations")
    return errors


def different_problems(rows, _):
    errors = []
    for key, members in group(rows, "scene", "seed", "step").items():
        for column in ("problem_hash", "state_hash"):
            values = {row[column] for row in members}
            if len(values) != 1 or "-" in values:
                errors.append(f"{key[0]} step {key[2]}: {len(values)} values of {column}")
    return errors


def empty_interfaces(rows, _):
    errors = []
    for key, members in group(filter(is_of_paper, rows), "scene", "partitioner", "refiner").items():
        rows_cut = max(row.integer("interface_rows") for row in members)
        unknowns = max(row.integer("interface_unknowns") for row in members)
        if rows_cut > 0 and unknowns <= 0:
            errors.append(f"{' '.join(key)}: interface rows, but never an interface unknown")
    return errors


def few_contacts(rows, _):
    errors = []
    for (scene,), members in group(rows, "scene").items():
        share = sum(row.integer("contacts") > 0 for row in members) / len(members)
        if share < LEAST_CONTACT_SHARE:
            errors.append(f"{scene}: contacts in {100 * share:.0f} % of the rows")
    return errors


def slow_partitions(rows, _):
    paper, errors = load_paper_table1(), []
    for key, members in group(rows, "scene", "partitioner", "refiner").items():
        mean = statistics.fmean(row.number("t_pr_ms") for row in members)
        if key in paper and not mean < paper[key][1]:
            errors.append(f"{' '.join(key)}: {mean:.3f} ms, the paper's {paper[key][1]} ms")
    return errors


ROW_CRITERIA = (
    ("every row has status ok", status_error),
    ("residual within the limit of an exact answer", residual_error),
    ("velocities of all combinations within 1e-8 m/s", spread_error),
    ("no part above its limit", part_size_error),
    ("refinement never adds interface rows", refinement_error),
    (f"kernel {PAPER['kernel']} with at most the interface rows as unknowns", interface_error),
    ("times finite, stages within t_s", times_error),
)
MATRIX_CRITERIA = (
    ("every scene is there", missing_scenes),
    ("enough measured steps in every scene", few_steps),
    (f"the paper's {len(COMBINATIONS)} combinations and all others on every step, each once", wrong_combinations),
    ("all combinations of a step solve one problem", different_problems),
    ("the interface system is really used", empty_interfaces),
    ("contacts in at least 20 % of the rows of every scene", few_contacts),
    ("mean t_pr below the paper's in every cell", slow_partitions),
)
