"""Runs of the fuzz targets (tests/fuzz): programs of libFuzzer, their corpora, findings and counts."""
import dataclasses
import datetime
import json
import os
import pathlib
import re
import subprocess
import tempfile
import time

from cleave_scripts.results.command import say
from cleave_scripts.results.command_line import counted
from cleave_scripts.results.errors import AlreadyTold, ResultError
from cleave_scripts.results.programs import ROOT, git, run_and_watch
from cleave_scripts.results.whole_file import write_bytes, write_text
from cleave_scripts.table import text

TARGETS = ("csv", "manifest", "options", "scene", "problem")
SOURCES = ROOT / "tests" / "fuzz"
LONGEST_BYTES = 4096  # of an input
TIMEOUT_S = 120  # of one input; far more than any takes, also on a busy machine
GIVEN = "CLEAVE_FUZZ_PROGRAMS"  # the variable that names a folder of programs
UNKNOWN = "unknown"  # the commit of these


@dataclasses.dataclass
class Result:
    """Of the last run of a target; kept as DIR/NAME.json, so that targets may run apart, or again after a mend."""
    target: str
    date: str
    commit: str  # whose program ran; UNKNOWN of programs that were given
    minutes: float
    executions: int
    edges: int  # of the program's branches that were reached
    edges_in_all: int
    inputs: int  # each of which reaches something that the others do not
    findings: list


def find_programs(about):
    """The folder of the programs: what GIVEN says, or where they are built now. about: what is said of the work."""
    given = os.environ.get(GIVEN)
    folder = pathlib.Path(given).resolve() if given else ROOT / "build" / "fuzz" / "tests" / "fuzz"
    if given and not all(os.access(folder / f"fuzz_{name}", os.X_OK) for name in TARGETS):
        raise ResultError(f"{GIVEN} is '{given}', which does not hold fuzz_{', fuzz_'.join(TARGETS)}")
    say(about + ("" if given else ", up to 7 more where nothing is built"))
    setup = [ROOT / "scripts" / "setup", "--preset", "fuzz", "--target", "fuzz_all"]
    if not given and subprocess.run(setup, check=False).returncode != 0:
        raise AlreadyTold
    return folder


def command(programs, name, *arguments):
    words = [programs / f"fuzz_{name}", f"-max_len={LONGEST_BYTES}", f"-timeout={TIMEOUT_S}", "-rss_limit_mb=4096",
             "-detect_leaks=0"]  # libraries keep what they have read
    dictionary = SOURCES / "dictionaries" / f"{name}.dict"
    return [*words, *([f"-dict={dictionary}"] if dictionary.exists() else []), *arguments]


def run(words, log):
    """The exit code: not 0 where an input is a finding, or where the program fails by itself."""
    in_memory = {"TMPDIR": "/dev/shm"} if os.access("/dev/shm", os.W_OK) else {}
    with open(log, "w", encoding="utf-8") as file:
        return run_and_watch(words, stdout=file, stderr=subprocess.STDOUT, env={**os.environ, **in_memory})


def fuzz(programs, name, out, seconds, made_of):
    """Fuzzes one target until the time is over, again after each finding; a known one again ends it.
    made_of: the commit of the programs."""
    corpus, folder, log = out / "corpus" / name, out / "findings" / name, out / f"{name}.log"
    for place in (corpus, folder):
        place.mkdir(parents=True, exist_ok=True)
    findings, begin, executions, text = set(), time.monotonic(), 0, ""
    while (left := seconds - (time.monotonic() - begin)) >= 1:
        code = run(command(programs, name, f"-max_total_time={int(left)}", f"-artifact_prefix={folder}/",
                           "-print_final_stats=1", corpus, SOURCES / "corpus" / name), log)
        text = log.read_text(encoding="utf-8", errors="replace")
        executions += last_number(r"stat::number_of_executed_units: +(\d+)", text)
        if code == 0:
            break
        found = re.findall(r"Test unit written to (.+)", text)
        if not found:
            raise ResultError(f"fuzz_{name} stopped with exit code {code}; see {log}")
        if found[-1] in findings:
            break
        findings.add(found[-1])
    result = Result(name, str(datetime.date.today()), made_of, (time.monotonic() - begin) / 60, executions,
                    last_number(r"cov: (\d+)", text), last_number(r"\((\d+) inline 8-bit counters\)", text),
                    last_number(r"corp: (\d+)", text), sorted(findings))
    write_text(out / f"{name}.json", json.dumps(dataclasses.asdict(result), indent=1) + "\n")
    return result


def last_number(pattern, text):
    found = re.findall(pattern, text)
    return int(found[-1]) if found else 0


def minimise(programs, name, out):
    """Inputs that were findings (finding-...) are kept whatever they reach."""
    corpus = SOURCES / "corpus" / name
    with tempfile.TemporaryDirectory() as scratch:
        smallest = pathlib.Path(scratch) / name
        smallest.mkdir()
        code = run(command(programs, name, "-set_cover_merge=1", smallest, corpus, out / "corpus" / name), out / f"{name}.log")
        if code != 0:
            raise ResultError(f"fuzz_{name} stopped with exit code {code}; see {out / name}.log")
        kept = {file.name for file in smallest.iterdir()}
        for file in smallest.iterdir():
            write_bytes(corpus / file.name, file.read_bytes())
    for file in corpus.iterdir():
        if file.name not in kept and not file.name.startswith("finding-"):
            file.unlink()


def commit():
    """What is checked out now, from which programs are built; of programs that are given nobody knows."""
    if os.environ.get(GIVEN):
        return UNKNOWN
    return git(ROOT, "rev-parse", "--short=10", "HEAD") + (" with local changes" if git(ROOT, "status", "--porcelain") else "")


def page(out):
    """The last result of each target that has run there."""
    kept = [out / f"{name}.json" for name in TARGETS]
    results = [Result(**json.loads(file.read_text(encoding="utf-8"))) for file in kept if file.exists()]
    found = sum(len(result.findings) for result in results)
    header = ["target", "date", "commit", "minutes", "executions", "branches reached", "of the program's",
              "inputs kept", "findings"]
    lines = ["# The last runs of the fuzzers", "", f"`scripts/fuzz`: {counted(found, 'finding')}.", "",
             text.table(header, [[result.target, result.date, result.commit, f"{result.minutes:.0f}", result.executions,
                                  result.edges, result.edges_in_all, result.inputs, len(result.findings)]
                                 for result in results]),
             "", "The program of a target holds code that it cannot reach: every solver, for instance. What each target reads "
                 "and what",
             "counts as a finding: [tests/fuzz/README.md](../../tests/fuzz/README.md).", ""]
    return "\n".join(lines)
