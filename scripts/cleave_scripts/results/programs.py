"""The programs that scripts run: CLEAVE_PROGRAM, or what is built now."""
import os
import pathlib
import subprocess

from cleave_scripts.results.errors import ResultError
from cleave_scripts.results.steps import load_steps

ROOT = pathlib.Path(__file__).resolve().parents[3]


def find_program(*targets):
    """Path of cleave, built with the targets named; with CLEAVE_PROGRAM nothing is built."""
    given = os.environ.get("CLEAVE_PROGRAM")
    if given:
        if not os.access(given, os.X_OK):
            raise ResultError(f"CLEAVE_PROGRAM is '{given}', which cannot be run")
        return pathlib.Path(given).resolve()
    chosen = [word for target in ("cleave", *targets) for word in ("--target", target)]
    if subprocess.run([ROOT / "scripts" / "setup", "--preset", "release", *chosen], check=False).returncode != 0:
        raise ResultError("set-up failed")
    return ROOT / "build" / "release" / "cleave"


def openblas_environment():
    """The environment with OpenBLAS on one thread and told what processor this is.

    Debian's OpenBLAS runs kernels for the oldest machines on processors newer than itself.
    """
    flags = pathlib.Path("/proc/cpuinfo").read_text(encoding="ascii", errors="replace").split()
    core = "SkylakeX" if "avx512f" in flags else "Haswell"
    return {"OPENBLAS_CORETYPE": core, **os.environ, "OPENBLAS_NUM_THREADS": "1"}


def benchmark_beside(program, name):
    """A program of tests/benchmarks of the same build."""
    return program.parent / "tests" / name


def run(command, allowed=(0,), **options):
    """Runs to the end; an exit code that is not allowed is a ResultError with its last line."""
    words = list(map(str, command))
    try:
        done = subprocess.run(words, stderr=subprocess.PIPE, text=True, check=False, **options)
    except FileNotFoundError:
        raise ResultError(f"{words[0]} is not built; run scripts/setup first") from None
    if done.returncode not in allowed:
        last = (done.stderr.strip().splitlines() or ["no message"])[-1]
        raise ResultError(f"{' '.join(words[:2])} stopped with exit code {done.returncode}: {last}")


def record(program, directory, scene, at, *options):
    """Problem files of the steps `at`, in their order."""
    run([program, "record", "--scene", scene, "--at", ",".join(map(str, at)), *options, "--out", directory, "--force"])
    return [directory / f"{scene}_step{step:06}.h5" for step in at]


def replay(program, directory, files, *options, all_ok=False):
    """Rows of a replay, also of cells that failed, unless all have to be ok."""
    run([program, "replay", *files, *options, "--out", directory, "--force"], allowed=(0, 2))
    rows = load_steps(directory / "steps.csv")[0]
    failed = [row for row in rows if row["status"] != "ok"]
    if all_ok and failed:
        first = failed[0]
        raise ResultError(f"{len(failed)} of {len(rows)} replayed cells are not ok, first: step {first['step']}, "
                          f"{first['partitioner']} {first['refiner']}: status {first['status']}")
    return rows
