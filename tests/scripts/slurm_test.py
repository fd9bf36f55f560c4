"""scripts/slurm/submit under a real Slurm: a task is killed in mid-array and requeued, a node drained, a task cancelled."""
import csv
import os
import pathlib
import shlex
import signal
import subprocess
import tempfile
import unittest

from slurm_cluster import NODES, Cluster, until
from synthetic import PROGRAM, SCRIPTS

TASKS = 4
# Two cells a task, each some seconds on an idle core.
SPEC = """
scene = "rock_pile"
bodies = 40
steps = 400
measure-every = 40
repeats = 1
partitioner = "mindp,mix"
refiner = "none"
solver = "schur"
seed = [1, 2, 3, 4, 5, 6, 7, 8]
"""
DEAD_HOST = "host: elsewhere\npid: 12\nstart: now\ncommand: cleave sweep\n"


def run(*words, code=0, **options):
    done = subprocess.run(list(map(str, words)), capture_output=True, text=True, timeout=600, check=False, **options)
    assert done.returncode == code, f"{words}: exit code {done.returncode}\n{done.stdout}{done.stderr}"
    return done


def read_rows(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def rows_of(table):
    """Rows of `cleave collect` in all columns but the machine's; cells by their names."""
    machine = {row["column"] for row in read_rows(table.with_suffix(".columns.csv")) if row["machine"] == "1"} | {"machine"}
    return [{name: pathlib.Path(value).name if name == "cell" else value
             for name, value in row.items() if name not in machine} for row in read_rows(table)]


class SlurmTest(unittest.TestCase):

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.directory = pathlib.Path(scratch.name)
        self.out, self.spec = self.directory / "out", self.directory / "spec.toml"
        (self.directory / "slurm").mkdir()
        self.cluster = self.enterContext(Cluster(self.directory / "slurm"))

    def submit(self, *words, code=0):
        return run(SCRIPTS / "slurm" / "submit", self.spec, "--tasks", TASKS, "--out", self.out, *words, code=code,
                   env=self.cluster.environment | {"CLEAVE_PROGRAM": PROGRAM})

    def submitted(self, *words):
        """{array: number, merge: number} of the jobs."""
        return dict(line.split() for line in self.submit("--", "--requeue", *words).stdout.splitlines())

    def share(self, task):
        return self.out / "shards" / f"{task}of{TASKS}"

    def cells_of(self, task):
        """Directories of the cells of a task that runs; none before it does."""
        index = self.share(task) / "index.csv"
        return [self.out / "cells" / row["cell"] for row in read_rows(index)] if index.exists() else []

    def kill_in_the_middle(self, array, task):
        """All processes of a task that has done its first cell and runs its second;
        then its node seems to have been another."""
        cells = until("the task runs", lambda: self.cells_of(task))
        until("its second cell runs", lambda: (cells[0] / "checksums").exists() and (cells[1] / "steps.csv").exists())
        lock = self.share(task) / "cleave.lock"
        pid = int(lock.read_text().partition("pid: ")[2].split()[0])
        self.assertIn(f"{task}/{TASKS}", pathlib.Path(f"/proc/{pid}/cmdline").read_text())
        os.kill(pid, signal.SIGKILL)
        self.assertEqual(self.cluster.end_of(f"{array}_{task}"), "0:9")
        for directory in (lock.parent, cells[1]):
            (directory / "cleave.lock").write_text(DEAD_HOST)

    def drain(self, *nodes):
        self.cluster.run("scontrol", "update", f"nodename={','.join(nodes)}", "state=drain", "reason=test")

    def resume(self, *nodes):
        self.cluster.run("scontrol", "update", f"nodename={','.join(nodes)}", "state=resume")

    def merged(self, number):
        """(exit code, what it printed) of the second job, once it has ended."""
        return self.cluster.end_of(number), (self.out / "slurm" / f"merge_{number}.out").read_text()

    def assert_rows_as_without_slurm(self):
        alone = self.directory / "alone"
        run(PROGRAM, "sweep", self.spec, "--out", alone, "--jobs", "2", "--quiet")
        run(PROGRAM, "collect", alone, "--out", self.directory / "alone.csv")
        expected, found = rows_of(self.directory / "alone.csv"), rows_of(self.out / "slurm" / "results.csv")
        self.assertEqual(found, expected)
        self.assertEqual(len({row["cell"] for row in found}), 8)
        self.assertGreater(len(found), 8)

    def test_a_campaign_survives_a_killed_task_and_a_drained_node(self):
        self.spec.write_text(SPEC)
        jobs = self.submitted()
        self.kill_in_the_middle(jobs["array"], 1)
        node = self.cluster.job(f"{jobs['array']}_2")["NodeList"]
        self.drain(node)
        self.cluster.run("scontrol", "requeue", f"{jobs['array']}_1")
        until(f"{node} is drained", lambda: self.cluster.states()[node] == "drained")
        self.assertEqual(self.cluster.run("squeue", "--noheader", f"--nodelist={node}"), "")
        self.resume(node)
        code, printed = self.merged(jobs["merge"])
        self.assertEqual(code, "0:0", printed)
        self.assertIn("8 cells: 8 ok", printed)
        self.assertEqual(self.cluster.job(f"{jobs['array']}_1")["Restarts"], "1")
        told = (self.out / "slurm" / f"task_{jobs['array']}_1.out").read_text()
        self.assertIn("1 cells are done and kept", told)
        self.assertEqual(told.count("left by process 12 on host elsewhere"), 2, told)
        self.assert_rows_as_without_slurm()
        run(PROGRAM, "verify", self.out)

    def test_what_is_missing_is_told_and_made_by_the_same_command(self):
        self.spec.write_text(SPEC.replace("bodies = 40", "bodies = 4"))
        self.drain(*NODES)
        jobs = self.submitted("--comment=a text")
        self.assertEqual(self.cluster.run("squeue", "--noheader", "--format=%k", f"--jobs={jobs['merge']}").strip(), "a text")
        self.assertIn(f"has jobs that have not ended: {jobs['array']}, {jobs['merge']}", self.submit(code=1).stderr)
        self.cluster.run("scancel", f"{jobs['array']}_2")
        self.resume(*NODES)
        code, printed = self.merged(jobs["merge"])
        self.assertEqual(code, "2:0", printed)
        self.assertIn("8 cells: 6 ok, 2 pending", printed)
        lines = [line.split(",")[:3:2] for line in printed.splitlines() if ",pending," in line]
        self.assertEqual(lines, [["2", "pending"], ["6", "pending"]])
        self.assertEqual(len({row["cell"] for row in rows_of(self.out / "slurm" / "results.csv")}), 6)

        again = self.submit("--", "--requeue")
        self.assertIn("8 cells, 6 done; 1 task of 4 to run", again.stderr)
        jobs = dict(line.split() for line in again.stdout.splitlines())
        self.assertEqual(self.merged(jobs["merge"])[0], "0:0")
        self.assert_rows_as_without_slurm()
        self.assertEqual(self.submit("--dry-run").stdout.count("sbatch"), 1)  # nothing is left but to merge
        self.assertIn("merge", self.submitted())


class CommandLineTest(unittest.TestCase):
    """Without any Slurm."""

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.directory = pathlib.Path(scratch.name)
        self.out, self.spec = self.directory / "100% out", self.directory / "spec.toml"
        self.spec.write_text(SPEC + "threads = [1, 2]\n")

    def submit(self, *words, code=0, **environment):
        return run(SCRIPTS / "slurm" / "submit", self.spec, "--out", self.out, *words, code=code,
                   env=os.environ | {"CLEAVE_PROGRAM": PROGRAM} | environment)

    def test_a_dry_run_writes_the_jobs_and_prints_the_commands(self):
        array, merge = map(shlex.split,
                           self.submit("--tasks", 3, "--dry-run", "--", "--time=1:00", "-p", "long").stdout.splitlines())
        for command in (array, merge):
            self.assertEqual(command[0], "sbatch")
            self.assertIn("--time=1:00", command)
            self.assertEqual(command[command.index("-p") + 1], "long")
        self.assertIn("--array=1,2,3", array)
        self.assertIn("--cpus-per-task=2", array)
        self.assertIn(f"--output={self.directory}/100%% out/slurm/task_%A_%a.out", array)
        self.assertIn("--dependency=afterany:ARRAY", merge)
        self.assertEqual((self.out / "slurm" / "spec.toml").read_text(), self.spec.read_text())
        for name in ("task.sh", "merge.sh"):
            run("bash", "-n", self.out / "slurm" / name)
        self.assertEqual({path.name for path in (self.out / "slurm").iterdir()}, {"spec.toml", "task.sh", "merge.sh"})

    def test_bad_input_is_refused_before_anything_is_written(self):
        for words, told in ((("--tasks", 17), "--tasks is '17', expected at most 16, the number of cells"),
                            (("--tasks", 2, "--", "--array=1-2"), "-- has '--array=1-2', which this command sets itself"),
                            (("--tasks", 2, "--", "long"), "-- is followed by 'long', expected an option of sbatch"),
                            (("--tasks", 2, "long"), "nothing is asked by 'long'"), (("--dry-run",), "--tasks is missing")):
            self.assertIn(told, self.submit(*words, code=1).stderr)
        self.spec.write_text("bodys = 3")
        self.assertIn("spec.toml:1: bodys", self.submit("--tasks", 1, code=1).stderr)
        self.assertFalse(self.out.exists())

    def test_without_slurm_that_is_said(self):
        self.assertIn("sbatch cannot be run", self.submit("--tasks", 2, code=1, PATH="/nowhere").stderr)


if __name__ == "__main__":
    unittest.main()
