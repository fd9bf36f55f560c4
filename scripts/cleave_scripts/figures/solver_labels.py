"""What a solver is called in figures: its name with the parameters that make it another, 'pgs, 100 sweeps'."""
import pandas

from cleave_scripts.results.about import solver_parameters, strategy_and_kernel
from cleave_scripts.results.names import base_name, said_parameters


def with_labels(rows, manifest):
    """Rows with their solver's label, parameters as (name, value) pairs, and the strategy that it asks for."""
    found = {text: solver_parameters(manifest, text) for text in rows["solver"].unique()}
    labels = {text: _label(text, *parameters) for text, parameters in found.items()}
    strategies = {text: strategy_and_kernel(manifest, text)[0] for text in found}
    solver = rows["solver"]
    return rows.assign(label=solver.map(labels),
                       parameters=[tuple(sorted(found[text][0].items())) for text in solver],
                       asked_strategy=solver.map(strategies))


def _label(text, values, defaults):
    changed = [_words(text, name, value) for name, value in sorted(values.items()) if value != defaults.get(name)]
    return ", ".join([base_name(text) if said_parameters(text) else text, *changed])


def _words(text, name, value):
    return _noun(text, name) if value in ("True", "true") else f"{value} {_noun(text, name)}"


def _noun(text, parameter):
    """The parameter less a word that the solver's name says already: iterations of ode-quickstep."""
    first, _, rest = parameter.partition("-")
    return rest if rest and first in base_name(text).split("-") else parameter


def solver_of(label):
    """The solver of a label like 'pgs, 100 sweeps'."""
    return label.partition(",")[0]


def families(table):
    """{solver: its rows, least first} of the solvers whose rows differ in the value of one numeric parameter.

    The rows get its value as `count` and what it counts as `unit`.
    """
    found = {}
    for solver, rows in table.groupby(table["label"].map(solver_of), sort=False):
        values = pandas.DataFrame(list(map(dict, rows["parameters"])), rows.index)
        varied = [name for name in values if values[name].nunique(dropna=False) > 1]
        counts = pandas.to_numeric(values[varied[0]], errors="coerce") if len(varied) == 1 else pandas.Series(dtype=float)
        if len(counts) and counts.notna().all():
            found[solver] = rows.assign(count=counts, unit=_noun(solver, varied[0])).sort_values("count")
    return found


def count_text(row, with_unit):
    return f"{row['count']:g} {row['unit']}" if with_unit else f"{row['count']:g}"


def full_names(table):
    """{label: it, in a family also with the value that is the default}"""
    names = {label: label for label in table["label"]}
    for rows in families(table).values():
        for _, row in rows.iterrows():
            words = count_text(row, with_unit=True)
            names[row["label"]] = row["label"] if words in row["label"] else f"{row['label']}, {words}"
    return names
