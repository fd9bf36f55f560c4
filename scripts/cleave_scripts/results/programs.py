"""The programs that scripts run: CLEAVE_PROGRAM, or what is built now."""
import contextlib
import json
import os
import pathlib
import signal
import subprocess
import tempfile

from cleave_scripts.results.build_key import build_key
from cleave_scripts.results.command import say
from cleave_scripts.results.errors import AlreadyTold, ResultError, last_line
from cleave_scripts.results.steps import load_steps

ROOT = pathlib.Path(__file__).resolve().parents[3]
# Programs of the preset peers, and the variables that name others.
PEERS, MUJOCO = ("cleave_peers", "CLEAVE_PEERS"), ("cleave_mujoco", "CLEAVE_MUJOCO")


def find_program(*targets, about, check=lambda program: None):
    """Path of cleave, built with the targets named; with CLEAVE_PROGRAM nothing is built.

    about: what is said of the work before it begins, such as how long it takes. check(program) refuses options that only the
    program can judge, before anything else is said where that is possible.
    """
    program = given_program("CLEAVE_PROGRAM")
    if program:
        check(program)
        say(about)
        return program
    say(about)
    program = build_program(("cleave", *targets))
    check(program)
    return program


def given_program(variable):
    """Path of the program that a variable of the environment names; None where it is not set."""
    given = os.environ.get(variable)
    if given and not (os.path.isfile(given) and os.access(given, os.X_OK)):
        raise ResultError(f"{variable} is '{given}', which cannot be run")
    return pathlib.Path(given).resolve() if given else None


def build_program(targets, root=ROOT):
    """Path of cleave, built with the targets in the checkout root by its own set-up."""
    chosen = [word for target in targets for word in ("--target", target)]
    if subprocess.run([root / "scripts" / "setup", "--preset", "release", *chosen], check=False).returncode != 0:
        raise AlreadyTold
    return root / "build" / "release" / "cleave"


def find_peer_program(name, variable):
    """Path of PEERS or MUJOCO: what the variable names, or what was built; nothing is built."""
    path = pathlib.Path(os.environ.get(variable, ROOT / "build" / "peers" / name))
    if not os.access(path, os.X_OK):
        raise ResultError(f"{path} cannot be run; scripts/setup --preset peers --target {name} builds it")
    return path.resolve()


def openblas_environment():
    """The environment with OpenBLAS on one thread and told what processor this is.

    Debian's OpenBLAS runs kernels for the oldest machines on processors newer than itself.
    """
    flags = pathlib.Path("/proc/cpuinfo").read_text(encoding="ascii", errors="replace").split()
    core = "SkylakeX" if "avx512f" in flags else "Haswell"
    return {"OPENBLAS_CORETYPE": core, **os.environ, "OPENBLAS_NUM_THREADS": "1"}


def benchmark_beside(program, name):
    """A program of tests/benchmarks in the same build directory; load_benchmark says whether it is of the same build."""
    return program.parent / "tests" / name


def run(command, allowed=(0,), **options):
    """Runs to the end; an exit code that is not allowed is a ResultError with its last line."""
    run_side_by_side([command], allowed, **options)


def run_side_by_side(commands, allowed=(0,), **options):
    """The same of programs that start at the same time. Where one fails the others are stopped."""
    with contextlib.ExitStack() as stack:
        running = [stack.enter_context(_running(list(map(str, command)), **options)) for command in commands]
        for process, said in running:
            if process.wait() not in allowed:
                said.seek(0)
                raise ResultError(f"{' '.join(process.args[:2])} stopped with exit code {process.returncode}: "
                                  f"{last_line(said.read())}")


@contextlib.contextmanager
def _running(words, **options):
    """(process, file of what it says); it does not outlive the context."""
    with tempfile.TemporaryFile("w+", errors="replace") as said:
        try:
            process = subprocess.Popen(words, stderr=said, **options)
        except FileNotFoundError:
            raise ResultError(f"{words[0]} is not built; run scripts/setup first") from None
        except OSError as error:
            raise ResultError(f"{words[0]} cannot be run: {error.strerror}") from None
        try:
            yield process, said
        finally:
            process.kill()
            process.wait()


def run_and_watch(command, **options):
    """The exit code, as a shell tells it, of a program that says itself what it does. When it is to be interrupted it is told
    once, and has the time that it needs to end well."""
    with subprocess.Popen(list(map(str, command)), process_group=0, **options) as process:
        try:
            code = process.wait()
        except KeyboardInterrupt:
            process.send_signal(signal.SIGINT)
            process.wait()
            raise
    return code if code >= 0 else 128 - code


def record(program, directory, scene, at, *options, all_ok=True):
    """Problem files of the steps `at`, in their order; unless all have to be ok,
    also where steps were moved by what is not exact."""
    run([program, "record", "--scene", scene, "--at", ",".join(map(str, at)), *options, "--out", directory, "--force"],
        allowed=(0,) if all_ok else (0, 2))
    return [directory / f"{scene}_step{step:06}.h5" for step in at]


def replay(program, directory, files, *options, all_ok=False):
    """Rows of a replay, also of cells that failed, unless all have to be ok."""
    return replay_side_by_side(program, [directory], files, *options, all_ok=all_ok)[0]


def replay_side_by_side(program, directories, files, *options, all_ok=False):
    """The same of a replay into each directory, started at the same time: rows of each."""
    run_side_by_side([[program, "replay", *files, *options, "--out", directory, "--force"] for directory in directories],
                     allowed=(0, 2))
    return [_replayed(directory / "steps.csv", all_ok) for directory in directories]


def _replayed(path, all_ok):
    rows = load_steps(path)[0]
    failed = [row for row in rows if row["status"] != "ok"]
    if all_ok and failed:
        first = failed[0]
        raise ResultError(f"{len(failed)} of {len(rows)} replayed cells are not ok, first: step {first['step']}, "
                          f"{first['partitioner']} {first['refiner']}: status {first['status']}")
    return rows


def git(root, *arguments):
    """What git says of the checkout root."""
    done = subprocess.run(["git", "-C", str(root), *arguments], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise ResultError(f"{root} is no git checkout")
    return done.stdout.strip()


def load_benchmark(path, program=None):
    """The rows that Google Benchmark has written, less what it makes of the repetitions itself (mean, median, spread). What a
    benchmark of another build than `program` has written is refused."""
    try:
        told = json.loads(path.read_text(encoding="utf-8"))
        rows, context = [row for row in told["benchmarks"] if row.get("run_type") != "aggregate"], dict(told.get("context", {}))
    except (AttributeError, ValueError, KeyError, TypeError):
        raise ResultError(f"{path}: not written by a benchmark program") from None
    if program is not None:
        _refuse_other_build(context, program)
    return rows


def _refuse_other_build(context, program):
    """context: what a benchmark says of itself (tests/benchmarks/build_context.h)."""
    key = build_key(program)
    mine, its = ([of.get(name, "unknown") for name in ("git_hash", "git_dirty")] for of in (key, context))
    if mine != its:
        builds = " and ".join(f"{commit[:10]} (local changes: {dirty})" for commit, dirty in (its, mine))
        raise ResultError(f"{context.get('executable', 'the benchmark')} and {program} are builds of commits {builds}; "
                          "build both anew")
