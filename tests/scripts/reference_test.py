"""scripts/reference in a small checkout whose scripts are stand-ins."""
import json
import os
import pathlib
import subprocess
import tempfile
import unittest
import unittest.mock

from synthetic import ROOT, SCRIPTS, run_script

from cleave_scripts.measurements import reference_files
from cleave_scripts.measurements.reference_stages import STAGES
from cleave_scripts.results.errors import ResultError

PROGRAM = f"""#!/usr/bin/python3
import sys
sys.path.insert(0, {str(ROOT / "tests" / "scripts")!r})
import stand_in_key
stand_in_key.answer()
"""
# Every script of a stage: notes its call, writes what the stage is to leave, ends as STAND_IN says of it.
SCRIPT = f"""#!/usr/bin/python3
import json, os, pathlib, sys, time
sys.path.insert(0, {str(ROOT / "tests" / "scripts")!r})
from stand_in_sweep import write_index
""" + """
name, arguments = os.path.basename(sys.argv[0]), sys.argv[1:]
with open(os.environ["STAND_IN_LOG"], "a") as log:
    log.write(" ".join([name, *arguments]) + "\\n")
with open(os.environ["STAND_IN_LOG"] + "_programs", "a") as log:
    log.write(" ".join(os.environ[f"CLEAVE_{which}"] for which in ("PROGRAM", "PEERS", "MUJOCO")) + "\\n")
time.sleep(json.loads(os.environ.get("STAND_IN_SECONDS", "{}")).get(name, 0))
code = json.loads(os.environ.get("STAND_IN", "{}")).get(name, 0)
out = pathlib.Path(arguments[arguments.index("--out") + 1] if "--out" in arguments else arguments[0] if arguments else ".")
LEFT = {
    "ladder": ["ladder.csv"], "extremes": ["extremes.csv"], "benchmark_solvers": ["solver_benchmark.json"],
    "benchmark_dense": ["dense_benchmark.json"], "busy_machine": ["busy_machine.csv"], "idle_cost": ["idle_cost.csv"],
    "benchmark_partitioners": ["partition_benchmark.json"], "two_threads": ["two_threads.csv"],
    "karger": ["karger.csv"], "partition_over_time": ["partition_over_time.csv"],
    "partition_worth": ["partition_worth.csv", "partition_worth.png"], "partition_regret": ["partition_regret.csv"],
    "partition_objectives": ["partition_objectives.csv"], "elimination_orders": ["elimination_orders.csv"],
    "compare_builds": ["compare_builds.csv"], "modelled_workers": ["modelled_workers.csv"],
    "running_simulation": ["running_simulation.csv"], "large_scenes": ["large_scenes.csv"],
    "model_savings": ["model_savings.csv"], "campaign_costs": ["campaign_costs.csv"],
    "friction_cost": ["friction_cost.csv"], "friction_forms": ["friction_forms.csv"],
    "friction_models": ["friction_motion.csv", "friction_velocities.csv", "friction_bounds.csv"],
    "coulomb_peers": ["coulomb_peers.csv"], "peers": ["peer_times.csv"],
    "hidden_choices": ["hidden_choices.csv", "hidden_choices_claims.csv", "hidden_choices_fit.csv", "verdict_map.png"],
    "tradeoff": ["tradeoff.csv", "tradeoff_partitions.csv", "tradeoff_motion.csv", "price_of_accuracy.png",
                 "time_to_accuracy.png", "crossover.png", "accuracy_profile.png", "tradeoff_motion.png"],
    "cold_starts": ["cold_starts.csv"], "ablation": ["ablation.csv"], "report": ["figures/verdicts.csv"],
    "readme_figures": ["figure2.png"],
}
# Campaigns and the labels of their cells.
CAMPAIGNS = {
    "reproduce": {"paper": ["chain_drop", "log_tower", "rock_pile", "large_rock_pile"]},
    "report_runs": {"scaling": ["bodies_50"], "report": ["motion/rock_pile", *(
        f"{name}/rock_pile" for name in ("one_thread", "schur_bodies", "solvers", "every_step", "karger"))]},
}
if code in (0, 2, 3):
    for campaign, labels in CAMPAIGNS.get(name, {}).items():
        for label in labels:
            for file in ("manifest.json", "steps.csv"):
                path = out / campaign / "cells" / label.replace("/", "-") / file
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(json.dumps({"argv": [str(path.resolve())]}) if path.suffix == ".json" else name)
        write_index(out / campaign, [{"cell": label.replace("/", "-"), "label": label} for label in labels])
    for file in LEFT.get(name, []):
        path = out / file
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps({"argv": [str(path.resolve())]}) if path.suffix == ".json" else name)
sys.exit(code)
"""


class ReferenceTest(unittest.TestCase):

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.directory = pathlib.Path(scratch.name).resolve()
        self.root, self.log = self.directory / "checkout", self.directory / "log"
        (self.root / "scripts").mkdir(parents=True)
        for name in {stage.command[0] for stage in STAGES} | {"readme_tables"}:
            self.executable(self.root / "scripts" / name, SCRIPT)
        self.executable(self.directory / "cleave", PROGRAM)
        (self.root / ".gitignore").write_text("out/\n")
        (self.root / "results" / "old").mkdir(parents=True)
        (self.root / "results" / "old" / "steps.csv").write_text("old")
        (self.root / "results" / "README.md").write_text("kept")
        (self.root / "results" / "torture").mkdir()
        (self.root / "results" / "torture" / "torture.json").write_text("made apart, kept")
        self.git("init", "-q")
        self.commit()

    def executable(self, path, text):
        path.write_text(text)
        path.chmod(0o755)

    def git(self, *arguments):
        done = subprocess.run(["git", "-C", self.root, "-c", "user.name=x", "-c", "user.email=x@x", *arguments],
                              capture_output=True, text=True, check=True)
        return done.stdout.strip()

    def commit(self):
        self.git("add", "-A")
        self.git("commit", "-q", "--allow-empty", "-m", "x")

    def run_it(self, code=0, told="{}", variables=(), **key):
        """(what was called, what was said)"""
        self.log.write_text("")
        key = {"git_hash": self.git("rev-parse", "HEAD"), **key}
        environment = dict(os.environ, CLEAVE_PROGRAM=str(self.directory / "cleave"),
                           CLEAVE_PEERS=str(self.directory / "cleave"), CLEAVE_MUJOCO=str(self.directory / "cleave"),
                           STAND_IN_LOG=str(self.log), STAND_IN=told, STAND_IN_KEY=json.dumps(key)) | dict(variables)
        result = run_script("reference", "--root", self.root, env=environment)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return self.log.read_text().splitlines(), result.stderr

    def results(self):
        folder = self.root / "results"
        return {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}

    def test_all_is_made_in_order_and_replaces_what_was_there(self):
        calls, said = self.run_it()
        self.assertEqual([call.split()[0] for call in calls], [stage.command[0] for stage in STAGES] + ["readme_tables"])
        self.assertIn(f"[1/{len(STAGES)}] matrix, about 11 min: scripts/reproduce --measure-every 10 "
                      "--out out/reference/report", said)
        self.assertEqual(self.results(), {
            "README.md", "torture/torture.json", "provenance.json", "extremes.csv", "solver_benchmark.json",
            "partition_benchmark.json",
            "dense_benchmark.json", "busy_machine.csv", "idle_cost.csv",
            "two_threads.csv", "karger.csv", "partition_over_time.csv", "partition_worth.csv", "partition_worth.png",
            "partition_regret.csv", "partition_objectives.csv", "elimination_orders.csv", "compare_builds.csv",
            "tradeoff.csv", "tradeoff_partitions.csv", "tradeoff_motion.csv", "price_of_accuracy.png",
            "time_to_accuracy.png", "crossover.png", "accuracy_profile.png", "tradeoff_motion.png", "model_savings.csv",
            "campaign_costs.csv", "friction_cost.csv", "friction_forms.csv", "friction_motion.csv",
            "friction_velocities.csv", "friction_bounds.csv", "coulomb_peers.csv", "peer_times.csv", "hidden_choices.csv",
            "hidden_choices_claims.csv", "hidden_choices_fit.csv", "verdict_map.png", "modelled_workers.csv",
            "running_simulation.csv", "large_scenes.csv", "cold_starts.csv", "ablation.csv",
            "ladder/ladder.csv", "ladder/ladder_full_exact.csv", "report/verdicts.csv", *(f"report/{run}/{file}" for run in (
                "scaling/bodies_50",
                *(f"{name}/rock_pile" for name in ("one_thread", "schur_bodies", "solvers", "every_step", "karger")))
                                     for file in ("manifest.json", "steps.csv", "checksums")),
            "figures/figure2.png", *(f"full/{scene}/{file}" for scene in
                                     ("chain_drop", "log_tower", "rock_pile", "large_rock_pile")
                                     for file in ("manifest.json", "steps.csv", "checksums"))})

    def test_what_a_kept_stage_has_lost_is_told_and_nothing_is_stored(self):
        self.run_it()
        before = self.results()
        for lost, told in (("tradeoff/crossover.png", "stage tradeoff: .* has no crossover.png; nothing is stored"),
                           ("report/scaling/cells/bodies_50/steps.csv",
                            "stage report_runs: .* has no steps.csv of scaling/bodies_50; nothing is stored"),
                           ("report/paper/cells/rock_pile/manifest.json",
                            "stage matrix: .* has no manifest.json of paper/rock_pile; nothing is stored"),
                           ("report/paper/index.csv", "stage matrix: .* has no paper/index.csv; nothing is stored")):
            self.git("checkout", "-q", "--", ".")
            self.git("clean", "-q", "-fd")
            path = self.root / "out/reference" / lost
            kept = path.read_bytes()
            path.unlink()
            _, said = self.run_it(code=1)
            self.assertRegex(said, told)
            self.assertEqual(self.results(), {"README.md", "torture/torture.json", "old/steps.csv"})
            path.write_bytes(kept)
        self.git("checkout", "-q", "--", ".")
        self.run_it()
        self.assertEqual(self.results(), before)

    def test_a_cell_that_crashed_has_nothing_to_lose(self):
        self.run_it()
        self.git("checkout", "-q", "--", ".")
        self.git("clean", "-q", "-fd")
        index = self.root / "out/reference/report/paper/index.csv"
        lines = [line.replace(",ok,-,-,", f",crashed,no,{'0' * 64},") if line.startswith("rock_pile,") else line
                 for line in index.read_text().splitlines(keepends=True)]
        index.write_text("".join(lines))
        (self.root / "out/reference/report/paper/cells/rock_pile/steps.csv").unlink()
        self.run_it()
        self.assertNotIn("full/rock_pile/steps.csv", self.results())

    def test_older_results_stay_until_all_is_written(self):
        self.run_it()
        self.git("checkout", "-q", "--", ".")
        self.git("clean", "-q", "-fd")
        copy, records, left = reference_files._copy, {stage.name: {} for stage in STAGES}, [20]

        def full_disk(*arguments):
            left[0] -= 1
            if left[0] < 0:
                raise ResultError("No space left on device")
            copy(*arguments)

        with unittest.mock.patch.object(reference_files, "_copy", full_disk), self.assertRaises(ResultError):
            reference_files.publish(self.root, records)
        self.assertLess({"old/steps.csv", "full/rock_pile/steps.csv"}, self.results())
        reference_files.publish(self.root, records)
        self.assertNotIn("old/steps.csv", self.results())
        self.assertIn("full/rock_pile/checksums", self.results())

    def test_stages_use_the_programs_that_were_checked(self):
        given = {f"CLEAVE_{which}": os.path.relpath(self.directory / "cleave") for which in ("PEERS", "MUJOCO")}
        self.run_it(variables=given)
        programs = set(pathlib.Path(f"{self.log}_programs").read_text().splitlines()[:len(STAGES)])
        self.assertEqual(programs, {" ".join([str(self.directory / "cleave")] * 3)})

    def test_what_a_stage_took_counts_earlier_starts_where_it_goes_on(self):
        for name in ("extremes", "tradeoff"):
            self.run_it(code=130, told=json.dumps({name: 130}), variables={"STAND_IN_SECONDS": json.dumps({name: 3})})
        self.run_it()
        notes = json.loads((self.root / "results/provenance.json").read_text())["files"]
        self.assertGreaterEqual(notes["extremes.csv"]["seconds"], 3)
        self.assertLess(notes["tradeoff.csv"]["seconds"], 3)

    def test_stages_go_on_where_their_command_runs_a_campaign(self):
        commands = {stage.command[0]: (SCRIPTS / stage.command[0]).read_text() for stage in STAGES}
        self.assertEqual({stage.command[0] for stage in STAGES if stage.resumes},
                         {name for name, source in commands.items() if "campaign.run(" in source or "run_sweep(" in source})

    def test_paths_in_manifests_are_relative_and_files_without_one_have_provenance(self):
        self.run_it()
        manifest = json.loads((self.root / "results/full/rock_pile/manifest.json").read_text())
        self.assertEqual(manifest["argv"], ["out/reference/report/paper/cells/rock_pile/manifest.json"])
        notes = json.loads((self.root / "results/provenance.json").read_text())["files"]
        self.assertEqual(set(notes) - {"figures"}, {name for name in self.results() if not name.endswith(
            ("README.md", "torture.json", "manifest.json", "steps.csv", "checksums", "provenance.json"))})
        summed = subprocess.run(["sha256sum", "--strict", "-c", "checksums"],
                                cwd=self.root / "results/full/rock_pile",
                                capture_output=True,
                                text=True,
                                check=True)
        self.assertEqual(summed.stdout, "manifest.json: OK\nsteps.csv: OK\n")
        note = notes["extremes.csv"]
        self.assertEqual(note["command"], "scripts/extremes --seeds 1 --out out/reference/extremes")
        self.assertEqual(note["build"], {"git_hash": self.git("rev-parse", "HEAD"), "git_dirty": "false",
                                         "compiler": "GCC 12.2.0", "flags": "-O3 -march=x86-64-v3",
                                         "build_type": "RelWithDebInfo"})
        self.assertEqual(note["machine"], {"cpu_model": "Some CPU", "cores": 2})

    def test_what_is_done_is_kept_on_the_same_commit_and_machine_alone(self):
        calls, _ = self.run_it(code=130, told='{"extremes": 130}')
        self.assertEqual(calls[-1].split()[0], "extremes")
        self.assertIn("old/steps.csv", self.results())
        self.assertEqual(self.run_it()[0][0].split()[0], "extremes")
        self.git("checkout", "-q", "--", ".")
        self.git("clean", "-qfd")
        self.assertEqual([call.split()[0] for call in self.run_it()[0]], ["readme_tables"])
        self.commit()
        self.assertEqual(len(self.run_it()[0]), len(STAGES) + 1)
        self.commit()
        self.run_it()
        self.git("checkout", "-q", "--", ".")
        self.git("clean", "-qfd")
        self.assertEqual(len(self.run_it(cpu_model="Other CPU")[0]), len(STAGES) + 1)

    def test_local_changes_and_other_builds_are_refused(self):
        for key, words in (({"git_hash": "f" * 40}, "is a build of commit ffffffffff"),
                           ({"git_dirty": "true"}, "local changes: true"),
                           ({"flags": "-O3 -march=native"}, "build with -O3 -march=native, expected RelWithDebInfo with "
                            "-march=x86-64-v3"), ({"build_type": "Debug"}, "is a Debug build")):
            calls, said = self.run_it(code=1, **key)
            self.assertEqual(calls, [])
            self.assertIn(words, said)
        (self.root / "new").touch()
        calls, said = self.run_it(code=1)
        self.assertEqual((calls, len(said.splitlines())), ([], 1))
        self.assertIn("local changes", said)

    def test_a_stage_that_fails_stops_all_and_a_failed_check_is_told_at_the_end(self):
        calls, said = self.run_it(code=1, told='{"two_threads": 1}')
        self.assertEqual(calls[-1].split()[0], "two_threads")
        self.assertIn("two_threads --out out/reference/two_threads stopped with exit code 1", said)
        _, said = self.run_it(code=3, told='{"two_threads": 3}')
        self.assertIn("two_threads: a check failed", said)


if __name__ == "__main__":
    unittest.main()
