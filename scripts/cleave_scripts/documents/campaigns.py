"""What campaigns cost besides their solves."""
from cleave_scripts.documents.stored import need
from cleave_scripts.measurements.campaign_costs import PROCESSES, RUNS, SOLVES, WORDS, median
from cleave_scripts.table import text

MADE_BY = "scripts/campaign_costs --paper out/report/paper"
COSTS = ("campaign_costs.csv", MADE_BY)


def campaign_costs(stored):
    rows = need(stored.table(*COSTS), "costs of campaigns", "what", "seconds", "peak_memory_mb")
    lines = [[words, f"{median(rows, what, 'seconds'):.2f}", f"{median(rows, what, 'peak_memory_mb'):.0f}"]
             for what, words in WORDS.items()]
    cells = next(row["cells"] for row in rows if row["what"] in WORDS)
    rounds = max(int(row["round"]) for row in rows)
    processes, runs, solves = (median(rows, what, "seconds") for what in (PROCESSES, RUNS, SOLVES))
    return (f"A campaign of {cells} cells of one row each, medians of {rounds} (`{MADE_BY}`; {stored.origin(COSTS[0])}):\n\n" +
            text.table(["", "seconds", "peak memory, MB"], lines) +
            f"\n\nCampaign `paper`: its processes took {processes:.0f} s, of which starting and ending them "
            f"{100 * (1 - runs / processes):.1f} %, and all that is not in the solves and partitions that are timed, moving "
            f"the worlds included, {100 * (1 - solves / processes):.1f} %.")


BLOCKS = {"campaign_costs": campaign_costs}
