"""One trial: its dice, its directory, what it ran, what it counts and what it finds."""
import collections
import dataclasses
import random
import shlex
import time

from cleave_scripts.torture import child
from cleave_scripts.torture.endings import fault
from cleave_scripts.torture.guarded import Unreadable, guarded
from cleave_scripts.torture.judge import judge_file
from cleave_scripts.torture.signals import held

SIGNS = 2000  # of what a program printed, in a finding


@dataclasses.dataclass(frozen=True)
class Finding:
    what: str  # equal faults have equal words here
    detail: str


class Trial:
    """kind, seed and number decide all that is random. Programs run in `directory`: their commands can be repeated there."""

    def __init__(self, kind, seed, number, directory, tools):
        self.kind, self.seed, self.number, self.directory = kind, seed, number, directory
        self.program, self.material, self.patience = tools.program, tools.material, tools.patience
        self.random = random.Random(f"{seed}/{kind}/{number}")
        self.counts = collections.Counter()
        self.findings, self.log, self.started = [], [], []

    def note(self, text):
        """A line for whoever repeats it: what was done to which file."""
        self.log.append(text)

    def count(self, name, number=1):
        self.counts[name] += number

    def find(self, what, detail=""):
        self.findings.append(Finding(what, detail[:SIGNS]))

    def start(self, *words, memory_mb=None, streams=""):
        limit = f"ulimit -v {memory_mb * 1024}; " if memory_mb else ""
        self.note(f"$ {limit}{shlex.join(['cleave', *map(str, words)])} {streams}".rstrip())
        self.count("programs")
        with held():  # until it is noted
            self.started.append(child.start([self.program, *words], self.directory, memory_mb, streams))
        return self.started[-1]

    def end(self):
        """Leaves nothing running, however the trial has ended."""
        for process in self.started:
            if process.poll() is None:
                child.kill_group(process)
                process.communicate()

    def finish(self, started):
        ending = child.finish(started, self.patience)
        self.note(f"  exit code {ending.code}" + (", killed after the patience" if ending.hung else ""))
        return ending

    def run(self, *words, allowed, memory_mb=None):
        """The Ending; one that is not as promised is a finding. The first word tells commands apart."""
        ending = self.finish(self.start(*words, memory_mb=memory_mb))
        self.check(ending, words[0], allowed)
        return ending

    def check(self, ending, command, allowed):
        """Whether it ended as promised."""
        wrong = fault(ending, allowed)
        if wrong:
            self.find(f"{command}: {wrong}", ending.err or ending.out)
        return wrong is None

    def judge(self, problem_path, solved_path):
        """{label: Verdict}; None where the judge cannot read what it is given."""
        try:
            return guarded(judge_file, problem_path, solved_path)
        except Unreadable as error:
            self.note(f"  judge: {error}")
            return None

    def wait(self, seconds):
        self.note(f"  after {seconds:.4f} s")
        time.sleep(seconds)
