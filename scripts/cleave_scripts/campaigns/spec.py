"""Campaigns that are shipped, with the keys that a script's options change, as text for `cleave sweep`."""
import json
import tomllib

from cleave_scripts.results.paper import DATA

FOLDER = DATA / "campaigns"


RULES = ("include", "exclude")  # lists of tables
MOST_INTEGER = 2**63 - 1  # of TOML; cleave sweep takes texts too


def load_spec(name):
    """What scripts/data/campaigns/NAME.toml says, by key."""
    return tomllib.loads((FOLDER / f"{name}.toml").read_text(encoding="utf-8"))


def spec_text(spec):
    """TOML: keys with a text, a number, true or false, or a list of these, then lists of tables of such keys."""
    tables = {key: value for key, value in spec.items() if key in RULES}
    lines = _lines({key: value for key, value in spec.items() if key not in RULES})
    for name, rules in tables.items():
        for rule in rules:
            lines += ["", f"[[{name}]]", *_lines(rule)]
    return "\n".join(lines) + "\n"


def _lines(table):
    return [f"{key} = {_value(value)}" for key, value in table.items()]


def _value(value):
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(map(_value, value))}]"
    if isinstance(value, int) and value > MOST_INTEGER:
        value = str(value)
    return json.dumps(value)  # of these kinds alone it is TOML as well
