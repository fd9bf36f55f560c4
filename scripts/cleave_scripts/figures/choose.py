"""Which blocks belong together: those of the paper's experiment, the longest run, and what a caption says of them."""
import pandas

from cleave_scripts.figures.tree import NoData, need
from cleave_scripts.results.command_line import counted
from cleave_scripts.results.manifest import machine
from cleave_scripts.results.names import in_order, title
from cleave_scripts.results.paper import REFINERS, SCENES


def combinations(rows):
    return set(zip(rows["partitioner"], rows["refiner"]))


def unscaled_parts(blocks, solver):
    """What the blocks have of the solver, in their order; scaling runs have nothing."""
    parts = (block.of_solver(solver) for block in blocks if not block.is_scaling)
    return [part for part in parts if part is not None]


def of_first_setup(parts):
    """Those that are repeated runs of the setup of the first."""
    first = parts[0] if parts else None
    return [
        part for part in parts
        if (part.setup, part.threads, part.label) == (first.setup, first.threads, first.label)
    ]


def main_blocks(blocks, solver):
    """By scene, the blocks behind Figures 3 and 5, Table 1 and the verdicts: repeated runs of one setup.

    Scaling runs are no candidates. Taken is the setup with the solver as it is by default, most combinations,
    most solves of a cell, most rows, most threads, and then the first by name; of its runs those with all
    these combinations, in the same order. Returns what was left out as lines too.
    """
    candidates = {}
    for part in unscaled_parts(blocks, solver):
        candidates.setdefault(part.scene, []).append(part)
    chosen, notes = {}, []
    for scene in in_order(candidates, SCENES):
        every = sorted(candidates[scene], key=preference)
        first = every[0]
        chosen[scene] = [
            part for part in of_first_setup(every) if combinations(first.rows) <= combinations(part.rows)
        ]
        others = sorted({part.experiment.name for part in every if part not in chosen[scene]})
        if others:
            notes.append(f"{title(scene)} of the paper's figures is {first.experiment.name}; "
                         f"of another setup or with fewer combinations: {', '.join(others)}")
    return chosen, notes


def preference(part):
    """Sorts blocks of one scene: first the one whose times say most."""
    return (not part.is_default, -len(combinations(part.rows)), -repeats(part),
            -len(part.rows), -(part.threads or 0), part.experiment.name)


def repeats(part):
    """How often each cell was solved; where that is unknown, once."""
    known = part.rows["repeat_count"].dropna() if "repeat_count" in part.rows else ()
    return known.min() if len(known) else 1


def most_steps(blocks, scene, solver, partitioner):
    """The blocks, repeated runs of one setup, that measured most steps of one partitioner with every refiner.

    Where no run is longer, the one of the paper's experiment, since `preference` decides then.
    """
    parts = [part for part in unscaled_parts(blocks, solver) if part.scene == scene]
    wanted = {(partitioner, refiner) for refiner in REFINERS}
    full = [part for part in parts if wanted <= combinations(part.rows)]
    parts = full or [part for part in parts if partitioner in set(part.rows["partitioner"])]
    if not parts:
        raise NoData(f"no rows of {partitioner} in scene {scene}")
    parts.sort(key=lambda part: (not part.is_default, -step_count(part.rows), preference(part)))
    steps = step_count(parts[0].rows)
    return [part for part in of_first_setup(parts) if step_count(part.rows) == steps]


def same_setup_with(blocks, scene, solver, partitioners):
    """The blocks, repeated runs of the setup that `preference` puts first, with rows of all these partitioners; or none."""
    parts = [
        part for part in unscaled_parts(blocks, solver)
        if part.scene == scene and set(partitioners) <= set(part.rows["partitioner"])
    ]
    return of_first_setup(sorted(parts, key=preference))


def merged_runs(group):
    """All rows of a group, each step of a seed once: where a run was repeated, with the medians of its times; repeats that
    failed do not count beside others."""
    rows = pandas.concat([part.rows for part in group], ignore_index=True)
    keys = [
        column for column in ("seed", "step", "partitioner", "refiner", "label") if column in rows.columns
    ]
    ok = rows["status"] == "ok"
    rows = rows[ok | ~ok.groupby([rows[key] for key in keys], dropna=False).transform("any")].reset_index(drop=True)
    repeated = rows.groupby(keys, dropna=False)
    for column in rows.columns[rows.columns.str.endswith("_ms")]:
        rows[column] = repeated[column].transform("median")
    if "repeat_count" in rows:
        rows["repeat_count"] = repeated["repeat_count"].transform("sum", min_count=1)
    return rows.drop_duplicates(keys)


def scenes_with(main, *columns):
    """({scene: rows with status ok that have the columns}, 'No data: ...' about the other scenes or '').

    NoData where no scene has such rows.
    """
    rows, gaps = {}, []
    for scene, group in main.items():
        frame = merged_runs(group)
        try:
            rows[scene] = need(frame[frame["status"] == "ok"], *columns)
        except NoData as gap:
            gaps.append(f"{title(scene)}, {gap}")
    if not rows:
        raise NoData("; ".join(gaps) or "no rows of the chosen solver in any scene")
    return rows, f"No data: {'; '.join(gaps)}. " if gaps else ""


def step_count(rows):
    return len(rows[["seed", "step"] if "seed" in rows else ["step"]].drop_duplicates())


def provenance(groups):
    """One sentence of a caption for {name: blocks}: measured steps, repeats and machines."""
    merged = {name: merged_runs(group) for name, group in groups.items()}
    steps = ", ".join(f"{name} {step_count(rows)}" for name, rows in merged.items())
    parts = [part for group in groups.values() for part in group]
    repeats = sorted({
        int(value) for rows in merged.values() if "repeat_count" in rows for value in rows["repeat_count"].dropna().unique()
    })
    text = f"Measured steps: {steps}."
    if repeats:
        often = "once" if repeats == [1] else f"{' or '.join(map(str, repeats))} times, the median counts"
        text += f" Each cell solved {often}."
    failed = sum((rows["status"] != "ok").sum() for rows in merged.values())
    if failed:
        text += f" {counted(failed, 'row')} with another status than ok."
    return text + " " + machines(parts)


def machines(parts):
    names = dict.fromkeys(machine(part.experiment.manifest) for part in parts)
    return f"{'Machine' if len(names) == 1 else 'Machines'}: {'; '.join(names)}."
