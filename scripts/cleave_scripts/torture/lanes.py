"""Trials side by side: every lane is a process that takes its share of the time and of the trials of each kind."""
import multiprocessing
import multiprocessing.connection
import os
import signal

from cleave_scripts.results.errors import ResultError
from cleave_scripts.torture.signals import held, let_through
from cleave_scripts.torture.tally import Tally

FORK = multiprocessing.get_context("fork")
AGAIN_S = 1  # an interrupt is told again


class Lanes:
    """make(lane, tally, tell) makes the trials of a lane, counts them in its tally and calls tell(text) meanwhile, with ""
    where only the counts are new."""

    def __init__(self, count, make):
        self.make, self.tallies, self.pipes, self.interrupted = make, [Tally() for _ in range(count)], {}, False
        self.parent = os.getpid()
        with held():  # one that has no handler yet would be killed or never told
            for lane in range(count):
                self._start(lane)
            self.before = signal.signal(signal.SIGINT, self._interrupt)

    def _start(self, lane):
        ours, theirs = FORK.Pipe(duplex=False)
        process = FORK.Process(target=self._run, args=(lane, theirs))
        process.start()
        theirs.close()
        self.pipes[ours] = lane, process

    def watch(self, tell):
        """tell(text, tally of all lanes) until the last lane has ended. Whether it was interrupted since the lanes began."""
        while self.pipes:
            for pipe in multiprocessing.connection.wait(self.pipes, AGAIN_S):
                self._take(pipe, tell)
            if self.interrupted:
                self._end_lanes()
        signal.signal(signal.SIGINT, self.before)
        return self.interrupted

    def _interrupt(self, *_):
        """No exception, which could come amid the reading of a pipe."""
        self.interrupted = True
        self._end_lanes()

    def _end_lanes(self):
        """Said until they have ended: a signal that comes just before a system call waits for the end of that call."""
        for _, process in self.pipes.values():
            process.terminate()

    def _take(self, pipe, tell):
        lane, process = self.pipes[pipe]
        try:
            text, self.tallies[lane] = pipe.recv()
        except EOFError:
            del self.pipes[pipe]
            process.join()
            if process.exitcode != 0:
                raise ResultError(f"lane {lane} of the trials stopped with exit code {process.exitcode}") from None
            return
        tell(text, Tally.of_all(self.tallies))

    def _run(self, lane, pipe):
        """A terminal interrupts all its processes; lanes are told by SIGTERM, of which the first counts. Programs under trial
        must not inherit a signal that is ignored, so it is caught."""
        signal.signal(signal.SIGINT, lambda *_: None)
        signal.signal(signal.SIGTERM, self._end)
        tally = Tally()

        def tell(text):
            if self.interrupted or os.getppid() != self.parent:
                raise KeyboardInterrupt
            pipe.send((text, tally))

        try:
            let_through()
            self.make(lane, tally, tell)
            tell("")
            signal.signal(signal.SIGTERM, lambda *_: None)  # which may still be on its way
        except KeyboardInterrupt:
            pipe.send(("", tally))

    def _end(self, *_):
        if not self.interrupted:
            self.interrupted = True
            raise KeyboardInterrupt
