"""What is counted of the trials of each kind, and the findings among them."""
import collections

COUNTS = {
    "trials": "trials",
    "programs": "programs run",
    "refused": "refused in one line",
    "accepted": "accepted",
    "noticed": "damage found and named",
    "harmless": "damage that changes nothing that is read",
    "unlisted": "edits of what cannot be recomputed, not found",
    "judged": "rows judged",
    "above": "rows above the limit",
    "not_judged": "rows that cannot be judged",
    "kills": "kills",
    "restarts": "restarts that completed",
    "findings": "findings",
}


class Tally:
    """Numbers by kind of trial and name of COUNTS, findings by kind and what was found."""

    def __init__(self):
        self.counts = collections.defaultdict(collections.Counter)
        self.found = collections.defaultdict(collections.Counter)
        self.seconds = collections.Counter()
        self.not_run = {}  # kind: why

    @classmethod
    def of_all(cls, tallies):
        """The sum."""
        sum_of_all = cls()
        for tally in tallies:
            sum_of_all.seconds.update(tally.seconds)
            sum_of_all.not_run.update(tally.not_run)
            for mine, theirs in ((sum_of_all.counts, tally.counts), (sum_of_all.found, tally.found)):
                for kind, numbers in theirs.items():
                    mine[kind].update(numbers)
        return sum_of_all

    def add(self, kind, trial, seconds):
        self.seconds[kind] += seconds
        self.counts[kind]["trials"] += 1
        self.counts[kind].update(trial.counts)
        for finding in trial.findings:
            self.counts[kind]["findings"] += 1
            self.found[kind][finding.what] += 1

    def total(self, name):
        return sum(counts[name] for counts in self.counts.values())

    def in_words(self):
        kinds = ", ".join(f"{kind} {counts['trials']}" for kind, counts in self.counts.items())
        return (f"{self.total('trials')} trials ({kinds}), {self.total('judged')} rows judged, {self.total('above')} above "
                f"the limit, {self.total('findings')} findings")
