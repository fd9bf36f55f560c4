#!/usr/bin/python3
"""Hostile trials of `cleave verify` on output directories: bits are flipped in their files, and cells of their
steps.csv are edited with all checksums rewritten to suit. Every flip must be found and the file named, every edit
found and the row named.

    tests/trials/directory_trials.py --flips 2000 --edits 2000 --seed 1
"""
import argparse
import csv
import hashlib
import io
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))

from cleave_scripts.results.programs import find_program  # noqa: E402

SCENE = ("--scene", "rock_pile", "--bodies", "12")
SPLIT = ("--max-bodies", "4", "--repeats", "1")

# Columns that results/README.md lists as found in a replay that wrote its solutions; in every directory those
# of the options and of the sums.
OPTIONS = ("run_id partitioner refiner solver threads repeat_count gravity_m_per_s2 match_tolerance contact_cap "
           "skip_small_islands cold mode advance steps scene_options schema_version problem_file max_bodies tau_mr "
           "tau_mix max_growth edge_weight degree degree_scope as_printed sweeps max_iterations scene seed step time_s "
           "friction dt_s cfm erp").split()
SUMS = ("rows rows_bilateral rows_normal rows_friction contacts t_s_ms t_s_analyze_ms t_s_predict_ms t_s_assemble_ms "
        "t_s_factor_local_ms t_s_form_interface_ms t_s_factor_interface_ms t_s_solve_ms t_s_check_ms t_s_refine_ms "
        "t_s_other_ms t_s_min_ms t_s_max_ms t_pr_ms status status_reason").split()
SPLIT_TIMES = ["t_partition_ms", "t_refine_ms"]
PROBLEM = "bodies islands problem_hash".split()
WORLD = ("contact_cap_hits t_collide_ms t_extract_ms t_predict_ms max_penetration_m potential_energy_j state_hash "
         "joint_drift_m last_body_z_m").split()
UNMEASURED = "ode_messages velocity_spread_m_per_s".split()
PARTS = ("parts max_part_bodies cut_pairs interface_rows interface_bodies interface_cover_bodies contiguous "
         "part_mass_ratio_max parts_before max_part_bodies_before cut_pairs_before interface_rows_before "
         "interface_bodies_before contiguous_before").split()
JUDGED = ("residual_m_per_s residual_bilateral_m_per_s residual_normal_m_per_s residual_friction_m_per_s "
          "residual_relative largest_free_velocity_m_per_s kinetic_energy_j energy_excess_j bound_mismatch "
          "part_condition_max").split()
STORED = "strategy kernel solution_hash".split()

COLUMNS = {
    "run": OPTIONS + SUMS + SPLIT_TIMES + PROBLEM + WORLD,
    "recorded": OPTIONS + SUMS + SPLIT_TIMES + PROBLEM,
    "replayed": OPTIONS + SUMS + SPLIT_TIMES + PROBLEM + WORLD + UNMEASURED + PARTS + JUDGED + STORED,
}


def make_directories(program, root):
    """A run with motion, a recording and a replay of it with solutions; their names."""

    def call(*arguments):
        subprocess.run([program, *map(str, arguments)], check=True, capture_output=True, timeout=600)

    pairs = ("--partitioner", "mindp,mix", "--refiner", "none,fm")
    call("run", *SCENE, *SPLIT, *pairs, "--steps", 40, "--measure-every", 20, "--record-motion", "--out", root / "run")
    call("record", *SCENE, "--at", "40,60", "--max-bodies", 4, "--advance", "schur", "--repeats", 1, "--out",
         root / "recorded")
    files = sorted((root / "recorded").glob("*.h5"))
    call("replay", *files, *SPLIT, *pairs, "--solver", "schur,exact", "--write-solutions", "--out", root / "replayed")
    return list(COLUMNS)


def failures(program, directory):
    """Exit code and lines of failed checks, where nothing but those was said to be wrong."""
    result = subprocess.run([program, "verify", directory],
                            capture_output=True,
                            text=True,
                            errors="replace",
                            timeout=600,
                            check=False)
    return result.returncode, [line for line in result.stdout.splitlines() if line.startswith("FAIL")], result.stderr


def flip_bit(rng, directory):
    path = rng.choice(sorted(directory.iterdir()))
    content = bytearray(path.read_bytes())
    place, bit = rng.randrange(len(content)), rng.randrange(8)
    content[place] ^= 1 << bit
    path.write_bytes(content)
    return path.name, f"bit {bit} of byte {place}"


def rewrite_checksums(directory):
    names = sorted(path.name for path in directory.iterdir() if path.name != "checksums")
    (directory / "checksums").write_text("".join(
        f"{hashlib.sha256((directory / name).read_bytes()).hexdigest()}  {name}\n" for name in names))


def other_number(rng, column, text, row):
    """Beyond the rounding that results/README.md allows."""
    value = float(text)
    sign = rng.choice((-1, 1))
    if re.fullmatch(r"-?\d+", text) and column not in JUDGED and not column.startswith("t_"):
        return str(int(text) + sign * rng.randint(1, 5))
    least = 1e-8 * max(1, float(row["kinetic_energy_j"])) if column in JUDGED else 1e-6
    return repr(value + sign * rng.uniform(1, 10) * max(least, 10**-rng.randint(1, 5) * abs(value)))


def other_cell(rng, column, row):
    """Another cell than the row's."""
    text = row[column]
    if column == "status":
        return rng.choice([name for name in ("ok", "not_converged", "refused", "skipped", "fine") if name != text])
    if text in ("nan", "-", ""):
        return rng.choice(("0", "1.5", "none", "7"))
    try:
        if text != "inf":
            return other_number(rng, column, text, row)
    except ValueError:
        pass
    place = rng.randrange(len(text))
    return text[:place] + rng.choice([c for c in "abcxyz0189" if c != text[place]]) + text[place + 1:]


def edit_cell(rng, directory, columns):
    """Changes one cell of steps.csv; the number of its line."""
    path = directory / "steps.csv"
    rows = list(csv.reader(io.StringIO(path.read_text())))
    line = rng.randrange(1, len(rows))
    row = dict(zip(rows[0], rows[line]))
    column = rng.choice([name for name in columns if name in row])
    cell = other_cell(rng, column, row)
    rows[line][rows[0].index(column)] = cell
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    path.write_text(text.getvalue())
    rewrite_checksums(directory)
    return line + 1, f"{column} = {row[column]} -> {cell}"


def trial(program, original, work, change, is_named):
    """Nothing where the change was found and named, else what happened."""
    shutil.rmtree(work, ignore_errors=True)
    shutil.copytree(original, work)
    where, what = change(work)
    code, failed, err = failures(program, work)
    if code == 3 and any(is_named(where, line) for line in failed):
        return None
    return f"{original.name}: {where}: {what}: exit code {code}, {failed[:3]} {err[-300:]}"


def run_trials(program, root, flips, edits, seed):
    """What was not found, in words."""
    rng = random.Random(seed)
    names = make_directories(program, root)
    for name in names:
        code, failed, err = failures(program, root / name)
        if code != 0:
            return [f"{name}: untouched, and yet exit code {code}: {failed} {err}"]
    missed = []
    for count, change, is_named in (
        (flips, lambda name: lambda work: flip_bit(rng, work), lambda file, line: file in line),
        (edits, lambda name: lambda work: edit_cell(rng, work, COLUMNS[name]),
         lambda number, line: re.search(rf"line {number}\b", line)),
    ):
        for _ in range(count):
            name = rng.choice(names)
            missed.append(trial(program, root / name, root / "work", change(name), is_named))
    return [text for text in missed if text]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--flips", type=int, default=2000)
    parser.add_argument("--edits", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as root:
        missed = run_trials(find_program("cleave"), pathlib.Path(root), options.flips, options.edits, options.seed)
    for text in missed:
        print(text)
    print(f"{options.flips} flips and {options.edits} edits, seed {options.seed}: {len(missed)} not found")
    return 3 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
