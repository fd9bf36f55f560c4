"""A script's campaign, run by `cleave sweep`: the options that such scripts have, how it is begun, and how it ended."""
import contextlib
import dataclasses
import pathlib
import re
import subprocess
import tempfile
import time

from cleave_scripts.campaigns.spec import spec_text
from cleave_scripts.results import option_types
from cleave_scripts.results.command import say
from cleave_scripts.results.errors import AlreadyTold, Interrupted, ResultError, last_line
from cleave_scripts.results.programs import run_and_watch

FAILED_CELLS = 2  # the exit code of a campaign whose results stand all the same
KEPT = "up to 7 more where cleave is not built; what is complete is kept"


def add_options(parser, steps, measured, out):
    """--steps, --measure-every, --out and --force. measured: how many steps are, unless told otherwise."""
    count = option_types.whole_number(1)
    parser.add_argument("--steps", type=count, default=steps, metavar="N", help="of every run (default %(default)s)")
    parser.add_argument("--measure-every", type=count, metavar="K",
                        help=f"measure every K-th step (default: {measured})")
    parser.add_argument("--out", metavar="DIR", **out)
    parser.add_argument("--force", action="store_true", help="run again what is complete")


def add_timing_options(parser):
    parser.add_argument("--repeats", type=option_types.whole_number(1), default=3, metavar="R",
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


def asked(options, *keys):
    """{key of a spec: value} of the options with these names."""
    return {key: getattr(options, key.replace("-", "_")) for key in keys}


@dataclasses.dataclass(frozen=True)
class Campaign:
    """A spec, what errors call it, and where it lies."""
    name: str
    spec: dict
    out: pathlib.Path

    @contextlib.contextmanager
    def command(self, program, *words):
        """(words, options of a process) of `cleave sweep`, while the spec is a file."""
        with tempfile.TemporaryDirectory(prefix="cleave_campaign_") as scratch:
            file = f"{self.name}.toml"
            (pathlib.Path(scratch) / file).write_text(spec_text(self.spec), encoding="utf-8")
            yield [*map(str, (program, "sweep", file, "--out", self.out.absolute(), *words))], {"cwd": scratch}

    def check(self, program):
        """Refuses, before anything is run or said, what the program does not take. Keys of a spec are options, and named so."""
        with self.command(program, "--dry-run") as (words, options):
            done = subprocess.run(words, capture_output=True, text=True, errors="replace", check=False, **options)
        if done.returncode != 0:
            said = last_line(done.stderr, f"cleave sweep stopped with exit code {done.returncode}")
            raise ResultError(re.sub(r"^cleave sweep: ([^:]*\.toml:\d+: (?=[a-z]))?",
                                     lambda place: "--" if place[1] else "", said))

    def run(self, program, *words, force=False):
        """The exit code of a campaign that ran to its end: 0, or 2 where a cell is not ok."""
        with self.command(program, *words, *["--force"] * force) as (words, options):
            return run_sweep(words, self.name, **options)


def run_sweep(words, name, **options):
    """The exit code of `cleave sweep` with these words, where it ran the campaign of this name to its end: 0,
    or 2 where a cell is not ok."""
    try:
        code = run_and_watch(words, **options)
    except KeyboardInterrupt:
        code = 130
    if code == 130:
        raise Interrupted("the same command goes on, finished cells are kept")
    if code == 1:
        raise AlreadyTold
    if code not in (0, FAILED_CELLS):
        raise ResultError(f"cleave sweep stopped with exit code {code} on campaign {name}")
    return code


def duration(start_s):
    """Since a moment of time.monotonic()."""
    minutes, seconds = divmod(int(time.monotonic() - start_s), 60)
    return f"{minutes} min {seconds} s"


def say_where(out, start_s):
    say(f"results in {out}, {duration(start_s)}")
