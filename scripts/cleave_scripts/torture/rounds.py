"""Which trial is next, until the time or the number of trials is up."""
import pathlib
import shutil
import tempfile
import time
import traceback

from cleave_scripts.torture.material import Material
from cleave_scripts.torture.trial import Trial


class Rounds:
    """Kinds take turns so that each has its share of the time. program, material and patience are what trials work with; lane
    is which of the lanes side by side: trials of a kind are dealt to them by turns."""

    def __init__(self, program, kinds, options, keeper, lane, tally, tell):
        self.program, self.patience = program, options.patience
        self.kinds, self.options, self.keeper, self.tally, self.tell = kinds, options, keeper, tally, tell
        self.lane, self.lanes = lane, options.side_by_side
        self.material = None
        self.begin = time.monotonic()

    def run(self):
        with tempfile.TemporaryDirectory(prefix="torture.") as scratch:
            scratch = pathlib.Path(scratch)
            self.material = Material(self.program, scratch / "material")
            (scratch / "material").mkdir()
            for kind in self._present():
                self.tally.counts[kind.name]["trials"] = 0
            while kind := self._next():
                self._make(kind, scratch)
                self.tell("")

    def _present(self):
        """Those that can be tried here. Of the others is said why not: nothing is passed over in silence."""
        for kind in self.kinds:
            why = kind.missing()
            if why:
                self.tally.not_run[kind.name] = why
                self.tell(f"NOT RUN: {kind.name}: {why}")
            else:
                yield kind

    def _next(self):
        """The kind that is furthest behind; None when nothing is left to do."""
        count = 1 if self.options.only is not None else self.options.count
        left = [kind for kind in self.kinds if kind.name in self.tally.counts and
                (count is None or self._number(kind) < count)]
        if self._seconds() * self.lanes >= 60 * self.options.minutes or not left:
            return None
        return min(left, key=lambda kind: self.tally.seconds[kind.name] / kind.share)

    def _number(self, kind):
        """Of the next trial of the kind, from 0."""
        return self.lane + self.lanes * self.tally.counts[kind.name]["trials"]

    def _make(self, kind, scratch):
        number = self._number(kind) if self.options.only is None else self.options.only
        directory = scratch / f"{kind.name}-{number}"
        directory.mkdir()
        trial, begin = Trial(kind.name, self.options.seed, number, directory, self), time.monotonic()
        try:
            kind.trial(trial)
        except Exception as error:  # a fault of the trial must be seen, and must not end the others
            trial.find(f"the trial itself fails: {type(error).__name__}", traceback.format_exc())
        finally:
            trial.end()
        self.tally.add(kind.name, trial, time.monotonic() - begin)
        if trial.findings:
            self.keeper.keep(trial, self.tell)
        shutil.rmtree(directory)

    def _seconds(self):
        return time.monotonic() - self.begin
