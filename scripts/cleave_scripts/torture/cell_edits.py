"""A cell of steps.csv that says something else than before."""
import math
import re

WORDS = ("", "-", "nan", "inf", "x", "0", "-1", "1e308", "ok")


def changed_cell(dice, text):
    """Another value, most often one that looks as good."""
    if dice.random() < 0.2:
        return dice.choice([word for word in WORDS if not _same(word, text)])
    value = _number(text)
    if value is None or not math.isfinite(value):
        return text + dice.choice(["x", "0"]) if value is None else dice.choice(["0", "1"])
    changed = dice.choice([_other_digit, _other_sign, _next_number])(dice, text)
    return changed if not _same(changed, text) else text.partition("e")[0] + "5e7"


def _other_digit(dice, text):
    places = [match.start() for match in re.finditer(r"\d", text.partition("e")[0])]
    place = dice.choice(places)
    return text[:place] + str((int(text[place]) + dice.randrange(1, 10)) % 10) + text[place + 1:]


def _other_sign(_dice, text):
    return text[1:] if text.startswith("-") else "-" + text


def _next_number(dice, text):
    return repr(float(text) * (1 + dice.choice([1e-3, -1e-3, 1e-6])) + (1 if float(text) == 0 else 0))


def _number(text):
    try:
        return float(text)
    except ValueError:
        return None


def _same(first, second):
    """As text, or as numbers."""
    one, other = _number(first), _number(second)
    if one is None or other is None:
        return first == second
    return one == other or math.isnan(one) and math.isnan(other)
