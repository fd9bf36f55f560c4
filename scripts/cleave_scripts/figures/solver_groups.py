"""Setups that several solvers have solved, and their rows on the steps they share."""
import pandas

from cleave_scripts.figures.choose import repeats
from cleave_scripts.results.command_line import counted
from cleave_scripts.results.names import title

MOST_PANELS = 4


def groups(blocks):
    """{name: blocks} of one scene and setup in which several solvers were measured, most solvers first."""
    found = [(key, parts) for key, parts in _alike(blocks) if len(_labels(parts)) > 1]
    for _, parts in found:
        parts.sort(key=lambda part: (-repeats(part), part.experiment.name))
    found.sort(key=lambda item: (-len(_labels(item[1])), item[1][0].experiment.name))
    names = _unlike([_name(key, parts) for key, parts in found], [_threads(key) for key, _ in found])
    names = _unlike(names, [_difference(key, found) for key, _ in found])
    return {name: parts for name, (_, parts) in zip(names, found)}


def _alike(blocks):
    """[((scene, setup, threads), blocks)]: setups in which nothing has two values are one, for a solver that splits nothing
    says nothing of parts."""
    found = []
    for block in blocks:
        if block.is_scaling or block.is_motion:
            continue
        for place, ((scene, setup, threads), parts) in enumerate(found):
            if (scene, threads) == (block.scene, block.threads) and _agree(setup, block.setup):
                found[place] = (scene, setup | block.setup, threads), [*parts, block]
                break
        else:
            found.append(((block.scene, block.setup, block.threads), [block]))
    return found


def _agree(setup, other):
    return len(dict(setup | other)) == len(setup | other)


def of_many_solvers(found):
    """The groups with at least half as many solvers as the first, which has most."""
    most = max((len(_labels(parts)) for parts in found.values()), default=0)
    return {name: parts for name, parts in found.items() if 2 * len(_labels(parts)) >= most}


def _labels(parts):
    return {label for part in parts for label in part.rows["label"]}


def _unlike(names, endings):
    """The names, those that stand there twice with their ending."""
    return [name if names.count(name) == 1 else f"{name}, {ending}" for name, ending in zip(names, endings)]


def _name(key, parts):
    bodies = parts[0].rows["bodies"].dropna() if "bodies" in parts[0].rows else []
    return title(key[0]) + (f", {bodies.iloc[0]:.0f} bodies" if len(bodies) else "")


def _threads(key):
    return counted(key[2] or "unknown", "thread")


def _difference(key, found):
    """The options that this setup does not share with the others of the scene."""
    shared = frozenset.intersection(*(other[1] for other, _ in found if other[0] == key[0]))
    return ", ".join(f"{name} {value}" for name, value in sorted(key[1] - shared)) or "another run"


def shared_rows(parts):
    """(rows on the steps that all solvers have in common, labels left out for having none in common)

    A repeated step of a solver and combination counts once. The solver with most steps comes first, so that
    one that was run elsewhere does not take the others along.
    """
    rows = pandas.concat([part.rows for part in parts], ignore_index=True)
    steps = ["seed", "step"] if "seed" in rows else ["step"]
    rows = rows.drop_duplicates([*steps, "label", "partitioner", "refiner"])
    rows = rows.assign(when=list(map(tuple, rows[steps].to_numpy())))
    by_label = rows.groupby("label")["when"].agg(set)
    common, left_out = None, []
    for label in sorted(by_label.index, key=lambda name: (-len(by_label[name]), name)):
        both = by_label[label] if common is None else common & by_label[label]
        if both:
            common = both
        else:
            left_out.append(label)
    return rows[rows["when"].isin(common) & ~rows["label"].isin(left_out)], left_out
