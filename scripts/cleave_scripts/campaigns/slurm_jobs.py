"""A campaign as jobs of Slurm: an array whose tasks are its shares, and a job behind it that makes one table of them.

    DIR/slurm/spec.toml            the campaign as it was submitted: what is changed later does not reach tasks that wait
    DIR/slurm/task.sh, merge.sh    the jobs
    DIR/slurm/jobs                 numbers of those submitted last, a line each
    DIR/slurm/task_JOB_I.out       what task I printed, of all times that it ran; merge_JOB.out
    DIR/slurm/results.csv          the table of `cleave collect`, those of cells and columns beside it
"""
import csv
import io
import re
import shlex
import subprocess

from cleave_scripts.results.errors import ResultError, last_line
from cleave_scripts.results.whole_file import write_text

# Slurm runs a task once at a time, and no two submissions have a campaign at once: locks of other hosts are of dead tasks.
TASK = """#!/bin/bash
# A share of the campaign, by the number of the task. Written by scripts/slurm/submit.
exec {sweep} --shard "$SLURM_ARRAY_TASK_ID/{tasks}" --take-over
"""
MERGE = """#!/bin/bash
# After all tasks, however they ended: one index, one table, and the cells that are missing. Written by scripts/slurm/submit.
code=0
{sweep} --merge --take-over || code=$?
{collect} || code=$((code ? code : $?))
exit $code
"""


def run(words, allowed=(0,)):
    """What a program prints; its last line, where it fails, is a ResultError."""
    words = list(map(str, words))
    try:
        done = subprocess.run(words, capture_output=True, text=True, errors="replace", check=False)
    except OSError as error:
        raise ResultError(f"{words[0]} cannot be run: {error.strerror}") from None
    if done.returncode not in allowed:
        raise ResultError(last_line(done.stderr, f"{words[0]} ended with exit code {done.returncode}"))
    return done


def read_cells(program, spec, out):
    """A row a cell: number, status, arguments. What is wrong with the spec or the directory is a ResultError."""
    return list(csv.DictReader(io.StringIO(run([program, "sweep", spec, "--out", out, "--dry-run"]).stdout)))


def shares_to_do(cells, tasks):
    """Numbers of the shares that have a cell which is not done."""
    return sorted({(int(cell["number"]) - 1) % tasks + 1 for cell in cells if cell["status"] == "pending"})


def most_threads(cells):
    """Of a cell, as the options of its run say."""
    return max(int(value) for cell in cells for value in re.findall(r"--threads=(\d+)", cell["arguments"]) or ["1"])


def running_jobs(folder):
    """Numbers of jobs of the last submission that have not ended."""
    file = folder / "jobs"
    known = file.read_text(encoding="ascii").split() if file.exists() else []
    found = []
    for job in known:
        number, _, cluster = job.partition(";")
        of_cluster = [f"--clusters={cluster}"] if cluster else []
        asked = run(["squeue", "--noheader", "--format=%F", f"--jobs={number}", *of_cluster], (0, 1))  # %F: of the whole array
        if asked.returncode != 0 and "Invalid job id" not in asked.stderr:
            raise ResultError(f"squeue does not say whether job {number} has ended: {' '.join(asked.stderr.split())}")
        found += [number] if number in asked.stdout.split() else []
    return found


def write_jobs(folder, program, spec, out, tasks):
    folder.mkdir(parents=True, exist_ok=True)
    copy = folder / "spec.toml"
    write_text(copy, spec)
    sweep = shlex.join(map(str, (program, "sweep", copy, "--out", out)))
    collect = shlex.join(map(str, (program, "collect", out, "--out", folder / "results.csv", "--force")))
    for name, text in (("task.sh", TASK), ("merge.sh", MERGE)):
        write_text(folder / name, text.format(sweep=sweep, collect=collect, tasks=tasks))


def array_command(folder, shares, cores, site):
    """Site options replace those before them."""
    return [
        "sbatch", f"--job-name={folder.parent.name}", f"--cpus-per-task={cores}", *printed_to(folder, "task_%A_%a.out"), *site,
        "--parsable", f"--array={','.join(map(str, shares))}", str(folder / "task.sh")
    ]


def merge_command(folder, array, site):
    """array: number of the job that it waits for, None where there is none."""
    after = [f"--dependency=afterany:{array}"] if array else []
    return [
        "sbatch", f"--job-name={folder.parent.name}-merge", *printed_to(folder, "merge_%j.out"), *site, "--parsable", *after,
        str(folder / "merge.sh")
    ]


def printed_to(folder, name):
    """Appended, so that a task that runs again does not take away what it said before."""
    return [f"--output={str(folder).replace('%', '%%')}/{name}", "--open-mode=append"]


def submit(folder, shares, cores, site):
    """(number of the array or None, number of the merge). Where only the first can be submitted it is taken back."""
    array = None
    if shares:
        array = run(array_command(folder, shares, cores, site)).stdout.strip()
        write_text(folder / "jobs", array + "\n")
    try:
        merge = run(merge_command(folder, array and array.partition(";")[0], site)).stdout.strip()
    except ResultError:
        if array:
            run(["scancel", array.partition(";")[0]], range(256))
        raise
    write_text(folder / "jobs", "\n".join(filter(None, (array, merge))) + "\n")
    return tuple(job and job.partition(";")[0] for job in (array, merge))
