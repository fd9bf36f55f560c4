"""Numbers as the documents write them."""
import math


def number(value, digits=3):
    """Three digits that count, without an exponent where it reads well: 0.0123, 4.56, 789, 12345, 1.2e-13."""
    if math.isnan(value):
        return "-"
    if value == 0:
        return "0"
    if not 1e-3 <= abs(value) < 1e6:
        mantissa, exponent = f"{value:.{digits - 2}e}".split("e")
        return f"{mantissa}e{int(exponent)}"
    decimals = digits - 1 - math.floor(math.log10(abs(value)))
    return f"{value:.{max(0, decimals)}f}"


def power(value):
    """A limit or a decade: 1e-8."""
    return f"{value:.0e}".replace("e-0", "e-")


def percent(share):
    return "-" if math.isnan(share) else f"{round(100 * share)} %"


def two_decimals(value):
    return "-" if math.isnan(value) else f"{value:.2f}"


def holds(is_so):
    return "holds" if is_so else "does not hold"


def table(header, rows):
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join("| " + " | ".join(map(str, line)) + " |" for line in lines)


def listed(words, last="and"):
    words = list(words)
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} {last} {words[-1]}" if words else "none"
