"""The claims of the paper and how they were judged."""
from cleave_scripts.documents.stored import need
from cleave_scripts.results.verdict_rule import RULE
from cleave_scripts.table import text

DATA = ("report/verdicts.csv", "scripts/report")
VERDICTS = ("reproduced", "not reproduced", "within noise", "open")


def _what(row):
    """'Log Tower (-0.11)': the part of the claim and the value found."""
    if not row["ours"]:
        return row["row"]
    value = float(row["ours"])
    is_share = row["column"] == "t_s_ms" and "exponent" not in row["row"]
    return f"{row['row']} ({text.percent(value) if is_share else text.number(value)})"


def verdicts(stored):
    rows = need(stored.table(*DATA), "verdicts")
    found = [name for name in VERDICTS if any(row["verdict"] == name for row in rows)]
    found += sorted({row["verdict"] for row in rows} - set(VERDICTS))
    lines = []
    for claim in dict.fromkeys(row["claim"] for row in rows):
        cells = ["; ".join(_what(row) for row in rows if row["claim"] == claim and row["verdict"] == name)
                 for name in found]
        lines.append([claim, *(cell or "" for cell in cells)])
    return text.table(["claim", *found], lines)


def verdict_counts(stored):
    rows = need(stored.table(*DATA), "verdicts")
    claims = {}
    for row in rows:
        claims.setdefault(row["claim"], set()).add(row["verdict"])
    whole = {name: [claim for claim, said in claims.items() if said == {name}] for name in VERDICTS}
    lines = [f"- **{name}**: {'; '.join(whole[name])}." for name in VERDICTS if whole[name]]
    mixed = [claim for claim, said in claims.items() if len(said) > 1]
    if mixed:
        lines.append(f"- **on some scenes or parts only**: {'; '.join(mixed)}.")
    return "\n".join(lines)


def verdict_rule(_):
    return RULE


BLOCKS = {"verdicts": verdicts, "verdict_counts": verdict_counts, "verdict_rule": verdict_rule}
