"""Series of runs of cleave, each in an output directory of its own: their options, and how they are made, kept and told."""
import dataclasses
import pathlib
import time

from cleave_scripts.results import option_types
from cleave_scripts.results.command import say
from cleave_scripts.results.command_line import counted
from cleave_scripts.results.errors import Interrupted, ResultError
from cleave_scripts.results.kept import RunDirectories, keep_or_run
from cleave_scripts.results.programs import find_program, run_and_watch

FAILED_CELLS = 2  # the exit code of a run whose results stand all the same
KEPT = "up to 3 more where cleave is not built; what is complete is kept"


@dataclasses.dataclass(frozen=True)
class Settings:
    """What all runs of a series have in common, unless one of them says otherwise."""
    steps: int
    measure_every: int
    repeats: int
    threads: int
    seed: int

    @property
    def measured(self):
        return self.steps // self.measure_every

    @property
    def words(self):
        return tuple(word for field in dataclasses.fields(self)
                     for word in (f"--{field.name.replace('_', '-')}", str(getattr(self, field.name))))


@dataclasses.dataclass(frozen=True)
class Run:
    """One output directory and what fills it. what: how an error calls it."""
    directory: pathlib.Path
    label: str
    what: str
    options: tuple
    settings: Settings

    @property
    def arguments(self):
        return ("run", *self.options, *self.settings.words)


def add_options(parser, steps, measured, out):
    """--steps, --measure-every, --out and --force. measured: how many steps are, unless told otherwise."""
    count = option_types.whole_number(1)
    parser.add_argument("--steps", type=count, default=steps, metavar="N", help="of every run (default %(default)s)")
    parser.add_argument("--measure-every", type=count, metavar="K",
                        help=f"measure every K-th step (default: {measured} of the steps)")
    parser.add_argument("--out", metavar="DIR", **out)
    parser.add_argument("--force", action="store_true", help="run again what is complete")


def add_timing_options(parser):
    count = option_types.whole_number(1)
    parser.add_argument("--repeats", type=count, default=3, metavar="R",
                        help="solves of each cell; t_s is their median (default %(default)s)")
    parser.add_argument("--threads", type=option_types.whole_number(1, option_types.MOST_THREADS), default=2, metavar="T",
                        help="(default %(default)s)")
    parser.add_argument("--seed", type=option_types.whole_number(0, option_types.MOST_SEED), default=1, metavar="X",
                        help="(default %(default)s)")


def check_measured(parser, options, measured):
    """Sets what is measured where it is not given, so that about so many steps are."""
    options.measure_every = options.measure_every or max(1, options.steps // measured)
    if options.measure_every > options.steps:
        parser.error(f"--measure-every is '{options.measure_every}', expected at most --steps, {options.steps}")


def settings_of(options):
    return Settings(options.steps, options.measure_every, options.repeats, options.threads, options.seed)


def duration(start_s):
    """Since a moment of time.monotonic()."""
    minutes, seconds = divmod(int(time.monotonic() - start_s), 60)
    return f"{minutes} min {seconds} s"


def run_all(runs, minutes, many, force):
    """Makes what is not there and says whether cells failed. many: what an interruption calls runs that are done."""
    store = RunDirectories()
    program = find_program(about=f"takes about {max(1, minutes)} min on 2 cores, {KEPT}",
                           check=lambda program: store.open(program, runs, force))
    codes = [keep_or_run(store, run, lambda run: _make(program, run, many), force, say) for run in runs]
    return FAILED_CELLS in codes


def _make(program, run, many):
    """The exit code of a run whose results stand."""
    say(f"{run.label}: {counted(run.settings.steps, 'step')}, measured are {run.settings.measured}")
    try:
        code = run_and_watch([program, *run.arguments, "--out", run.directory, "--force"])
    except KeyboardInterrupt:
        code = 130
    if code == 130:
        raise Interrupted(f"the same command goes on, finished {many} are kept")
    if code not in (0, FAILED_CELLS):
        raise ResultError(f"cleave stopped with exit code {code} on {run.what}")
    return code
