"""What options, columns and algorithms of a run change, as its manifest says: the problem, the partition, the solver.

Manifests of version 0.2 do not say it; scripts/data/older_manifests.toml does for them.
"""
import tomllib

from cleave_scripts.results.names import base_name, said_parameters
from cleave_scripts.results.paper import DATA

OLDER = tomllib.loads((DATA / "older_manifests.toml").read_text(encoding="utf-8"))
OLDER_OPTIONS = {name: about for about, names in OLDER["options"].items() for name in names}
RAN_AT_THE_END = ("strategy", "kernel")  # of one solver now this, now that; manifests of some builds called them the solver's
OLDER_COLUMNS = {name: about for about, names in OLDER["columns"].items() for name in names}


def options_about(manifest):
    """{option: what it changes}"""
    told = manifest.get("option_about")
    return told or {name: OLDER_OPTIONS.get(name, "problem") for name in manifest.get("options", {})}


def columns_about(manifest):
    """{column: what it says}"""
    return {entry["name"]: entry["about"] for entry in _entries(manifest, "columns", "about")} or OLDER_COLUMNS


def setup_columns(*manifests, about=("problem", "partition", "solver")):
    """Columns in which rows must not differ where a mean is taken over them."""
    found = {column: None for manifest in manifests or ({},) for column, what in columns_about(manifest).items()
             if what in about and column not in RAN_AT_THE_END}
    return tuple(found)


def solver_parameters(manifest, text):
    """({parameter: value}, {parameter: default}) of a solver that rows call `text`."""
    told = [entry for entry in _entries(manifest, "algorithms", "parameters") if entry.get("kind") == "solver"]
    for entry in told:
        if entry.get("text") == text:
            return _texts(entry["parameters"]), _texts(entry.get("defaults", {}))
    if told:
        return said_parameters(text), {}
    defaults = OLDER["parameters"] | OLDER["parameters_of"].get(base_name(text), {})
    options = manifest.get("options", {})
    return {name: str(options.get(name, value)) for name, value in defaults.items()} | said_parameters(text), defaults


def strategy_and_kernel(manifest, text):
    """What a solver is made of; of 'pivot:schur-rows' the name says it."""
    values = solver_parameters(manifest, text)[0]
    if "strategy" in values and "kernel" in values:
        return values["strategy"], values["kernel"]
    name = base_name(text)
    strategy, _, kernel = name.partition(":")
    return (strategy, kernel) if kernel else tuple(OLDER["made_of"].get(name, (name, name)))


def _entries(manifest, key, needed):
    found = manifest.get(key)
    return [entry for entry in found if isinstance(entry, dict) and needed in entry] if isinstance(found, list) else []


def _texts(parameters):
    return {name: str(value) for name, value in parameters.items()}
