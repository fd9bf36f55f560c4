"""A cell of steps.csv that says something else than before."""
import math
import re

WORDS = ("", "-", "nan", "inf", "x", "0", "-1", "1e308", "ok")


def changed_cell(dice, text, least):
    """Another value, most often one that looks as good. least: the smallest change of a number that is none."""
    if dice.random() < 0.2:
        return dice.choice([word for word in WORDS if not _same(word, text, least)])
    value = _number(text)
    if value is None:
        return text + dice.choice(["x", "0"])
    if not math.isfinite(value):
        return dice.choice(["0", "1", "7.5"])
    if re.fullmatch(r"-?\d+", text):
        return str(int(text) + dice.choice([-1, 1]) * dice.randrange(1, 6))
    return repr(value + dice.choice([-1, 1]) * dice.uniform(1, 10) * max(least, 10**-dice.randrange(1, 6) * abs(value)))


def _number(text):
    try:
        return float(text)
    except ValueError:
        return None


def _same(first, second, least):
    """As text, or as numbers that differ by less."""
    one, other = _number(first), _number(second)
    if one is None or other is None:
        return first == second
    return one == other or abs(one - other) <= least or math.isnan(one) and math.isnan(other)
