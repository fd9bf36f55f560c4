"""What stands in Table 1: times of a combination, ours and the paper's, and the cells of a scene."""
import dataclasses
import math

from cleave_scripts.results.names import title

MOST_WAITING = 0.05  # of t_s, for a core; above it a mean says more of the machine's other work
MOST_FAR = 0.05  # of t_s, on cores far apart; above it a mean says more of where they were


@dataclasses.dataclass
class Times:
    """One pair of times in ms; nan where there is none."""

    t_s_ms: float = math.nan
    t_pr_ms: float = math.nan

    @property
    def total_ms(self):
        return self.t_s_ms + self.t_pr_ms

    def __truediv__(self, other):
        """Ratios of t_s, t_pr and total; nan where one side is missing."""
        ours = (self.t_s_ms, self.t_pr_ms, self.total_ms)
        theirs = (other.t_s_ms, other.t_pr_ms, other.total_ms)
        return [a / b if b > 0 else math.nan for a, b in zip(ours, theirs)]


@dataclasses.dataclass
class Cell:
    partitioner: str
    refiner: str
    ours: Times = dataclasses.field(default_factory=Times)
    paper: Times = dataclasses.field(default_factory=Times)
    ok: int = 0  # measured steps that ours is the mean of
    failed: int = 0  # rows with another status; not in the mean
    missing: int = 0  # steps of the scene without a row of this combination
    waiting: float = math.nan  # share of t_s in which threads waited for a core; nan where unknown
    ours_lowest: bool = False
    paper_lowest: bool = False

    @property
    def complete(self):
        return self.ok > 0 and self.failed == 0 and self.missing == 0

    @property
    def waited(self):
        return self.waiting > MOST_WAITING

    @property
    def remark(self):
        parts = [
            f"{count} of {self.ok + self.failed + self.missing} steps {what}"
            for count, what in ((self.failed, "failed"), (self.missing, "missing"))
            if count
        ]
        return ", ".join(parts)


@dataclasses.dataclass
class SceneTable:
    scene: str
    steps: int  # measured
    threads: str
    solver: str
    cells: list  # Cell, in the paper's order
    differs: str = ""  # how the runs differ from the paper's in size; empty where they do not
    far: float = 0.0  # share of t_s on cores far apart

    @property
    def title(self):
        return title(self.scene)
