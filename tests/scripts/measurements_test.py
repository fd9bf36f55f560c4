"""scripts/modelled_workers, cold_starts, ablation and the benchmarks with stand-ins for the programs they run."""
import csv
import json
import os
import subprocess
import unittest
import unittest.mock

from stand_in import StandInCase
from synthetic import ROOT

from cleave_scripts.documents import cuts, speed, worth
from cleave_scripts.documents.stored import Stored
from cleave_scripts.measurements import dense_ratios, modelled_times, partition_worth
from cleave_scripts.results.paper import COMBINATIONS

STAND_IN = f"""#!/usr/bin/python3
import itertools, os, pathlib, sys
sys.path.insert(0, {str(ROOT / "tests" / "scripts")!r})
from synthetic import asked_partitioners, asked_refiners, write_manifest, write_steps
words = sys.argv[1:]
with open(os.environ["STAND_IN_LOG"], "a") as log:
    log.write(" ".join(words) + "\\n")
code = int(os.environ.get("STAND_IN_CODE", 0))  # of the replays after the first
replays = sum(line.startswith("replay ") for line in open(os.environ["STAND_IN_LOG"]))
if code and words[0] == "replay" and replays > 1:
    sys.exit("cleave replay: no" if code == 1 else code)
out = pathlib.Path(words[words.index("--out") + 1])
out.mkdir(parents=True, exist_ok=True)
if words[0] == "record":
    scene, steps = words[words.index("--scene") + 1], words[words.index("--at") + 1]
    for step in steps.split(","):
        (out / f"{{scene}}_step{{int(step):06}}.h5").write_text(" ".join(words))
    sys.exit(0)
if words[0] == "run":
    given = dict(zip(words, words[1:]))
    write_steps(out, [dict(scene=given["--scene"], bodies=600, step=step, partitioner=given["--partitioner"], refiner=given["--refiner"],
                           repartition=given["--repartition"], partition_origin="fresh", rows=1200 * step, interface_rows=40, parts=5,
                           t_pr_ms=0.1, t_s_ms=8) for step in range(int(given["--steps"]))])
    sys.exit(0)
files = [word for word in words if word.endswith(".h5")]
assert files and all(os.path.exists(file) for file in files), files
def recorded(file):
    asked = pathlib.Path(file).read_text().split()
    asked = dict(zip(asked, asked[1:]))
    return dict(scene=asked["--scene"], bodies=asked.get("--bodies", 600), cfm=float(asked.get("--cfm", 1e-5)), step=int(file[-9:-3]))
beside = out.name == "replay1"  # the second of two at the same time
threads = int(words[words.index("--threads") + 1]) if "--threads" in words else 1
given = dict(zip(words, words[1:]))
def alone_ms(step):
    return (float(os.environ.get("STAND_IN_MS", 8)) if step == 100 else 8) * (float(os.environ.get("STAND_IN_BESIDE", 1)) if beside else 1)
def apart_ns(threads, solver):
    return float(os.environ.get("STAND_IN_APART", 100) if threads > 1 and solver == "exact" else "nan")
def modelled(step, threads):
    # As measured, but for step 100 as the test says.
    two = alone_ms(step) / 2 * (float(os.environ.get("STAND_IN_MODEL", 1)) if step == 100 else 1)
    more = {{name: alone_ms(step) / 8 for name in ("t_s_critical_path_ms", *(f"t_s_model_p{{p}}_ms" for p in (4, 8, 16, 32, 64)))}}
    return {{"t_s_model_p2_ms": two, **more}} if threads == 1 else dict.fromkeys(("t_s_model_p2_ms", *more), float("nan"))
names = list(itertools.product(asked_partitioners(given.get("--partitioner", "-")), asked_refiners(given.get("--refiner", "-"))))
whole = ("pivot:monolithic",)  # ignore parts
path = write_steps(out, [dict(**recorded(file), partitioner="-" if solver in whole else partitioner, refiner="-" if solver in whole else refiner,
                       threads=threads, rows=1200, interface_rows=50 if "whole" in words else 40,
                       status=os.environ.get("STAND_IN_STATUS", "ok"), t_s_ms=alone_ms(int(file[-9:-3])) / threads, t_s_waiting_ms=float(os.environ.get("STAND_IN_WAITING", 0.25)),
                       core_round_trip_ns=apart_ns(threads, solver),
                       factorizations=9 if "--cold" in words else 2, seed=1, solver=solver,
                       t_pr_ms=float(os.environ.get("STAND_IN_AUTO_MS", 0.1)) if partitioner == "auto" else 0.1, calibration="-", auto_choice="-",
                       **modelled(int(file[-9:-3]), threads))
                  for file in files for partitioner, refiner in names for solver in given.get("--solver", "schur").split(",")])
os.utime(path, (0, float(os.environ.get("STAND_IN_LATE_S", 0)) if beside else 0))
write_manifest(out, machine={{"dispatch": {{"timing_us": 0.03, "task_us": 0.2, "graph_task_us": 0.4, "stage_us": 1.5}}}})
"""


class Measurement(StandInCase):
    stand_in = STAND_IN

    def stored(self):
        return Stored(self.directory / "out")

    def rows(self, name):
        with open(self.directory / "out" / name, newline="") as file:
            return list(csv.DictReader(file))

    def check_status_refused(self):
        """Cells that were not solved are one line, and nothing is written."""
        with unittest.mock.patch.dict(os.environ, STAND_IN_STATUS="not_converged"):
            said = self.run_it(code=1).stderr.splitlines()
        self.assertRegex(said[-1], r"replayed cells are not ok, first: step \d+, \S+ \S+: status not_converged")
        self.assertEqual(len(said), 2, said)  # the other says how long it takes
        self.assertFalse((self.directory / "out").exists())

    def check_least(self, option, least):
        """What is less than the least number of rounds or repetitions is one line, before anything runs."""
        self.check_refused(((option, least - 1), f"{option} is '{least - 1}', expected a whole number from {least} to 999999999; see"),
                           ((option, "x"), f"{option} is 'x', expected a whole number from {least} to"))


class ModelledWorkersTest(Measurement):
    script = "modelled_workers"
    cells = 5 * 2 * 4  # problems, steps, solvers

    def model(self, share, code=0, ms=20, waiting_ms=0.1):
        """Step 100 takes ms on one thread and half of it on two, which the model gives times share; step 200 takes 8 ms."""
        with unittest.mock.patch.dict(os.environ, STAND_IN_MODEL=str(share), STAND_IN_MS=str(ms), STAND_IN_WAITING=str(waiting_ms)):
            return self.run_it("--rounds", 3, code=code)

    def test_one_and_two_threads_take_turns_on_the_same_files(self):
        self.model(1)
        calls = self.calls()
        records, replays = ([call for call in calls if call.startswith(word)] for word in ("record", "replay"))
        self.assertEqual(len(records), 5)
        self.assertEqual([call[call.index("--threads"):].split()[1] for call in replays], ["1", "2", "2", "1", "1", "2"])
        rows = self.rows("modelled_workers.csv")
        self.assertEqual(len(rows), 3 * 2 * self.cells)
        self.assertEqual({(row["task_us"], row["stage_us"]) for row in rows}, {("0.2", "1.5")})

    def test_the_error_of_slow_steps_decides_and_all_others_are_shown(self):
        said = self.model(0.9).stdout
        self.assertIn("Steps of 5 ms and more on two threads: 20, median error 10.0 %, from -10 to -10 %; with medians over", said)
        self.assertIn("| rock_pile | 200 | 1e-05 | 100 | exact | 20.0 | 9.00 | 10.0 | -10 % | 2.50 | 2.50 | 2.50 |", said)
        self.assertIn("Steps below 5 ms: 20, median error 0.0 %", said)
        self.assertIn("| rock_pile | 200 | 1e-05 | 200 | exact | 8.00 | 4.00 | 4.00 | +0 % |", said)
        self.assertIn("Charged: 200 ns an independent task and 400 ns a task of a graph, less the 30 ns", said)
        self.assertIn("pass  median error over steps of 5 ms and more on two threads: 10.0 %, limit 15 %", said)
        self.assertIn("FAIL  median error over steps of 5 ms and more on two threads: 20.0 %", self.model(1.2, code=3).stdout)
        self.assertIn("FAIL  median error", self.model(0.8, code=3).stdout)

    def test_a_slow_round_is_only_in_the_medians(self):
        def row(threads, number, t_s_ms):
            return {"scene": "s", "bodies": 7, "cfm": 0, "step": 1, "solver": "exact", "threads": threads, "round": number,
                    "t_s_ms": t_s_ms, "t_s_waiting_ms": 0, **dict.fromkeys(modelled_times.SHOWN.values(), t_s_ms / 10),
                    modelled_times.MODEL: 0.5 * t_s_ms}
        rows = [row(1, number, ms) for number, ms in enumerate((30, 20, 40))]
        rows += [row(2, number, ms) for number, ms in enumerate((12.5, 24, 24))]
        (step,), waited = modelled_times.compare(rows)
        self.assertEqual((step.one_ms, step.modelled_ms, step.measured_ms, waited), (20, 10, 12.5, 0))
        self.assertAlmostEqual(step.error, -0.2)
        self.assertAlmostEqual(step.median_error, 15 / 24 - 1)
        self.assertEqual(step.more_ms, [2, 2, 2])

    def test_the_document_says_the_same(self):
        self.model(0.9)
        made = speed.modelled_workers(self.stored())
        self.assertIn("the fastest of 3 rounds, seed 1, `mix+fm`", made)
        self.assertIn("| rock_pile | 200 | 1e-05 | 100 | exact | 20.0 | 9.00 | 10.0 | -10 % |", made)

    def test_without_slow_steps_or_a_core_nothing_is_decided(self):
        self.assertIn("no step took 5 ms", self.model(1, code=1, ms=9).stderr.splitlines()[-1])
        said = self.model(0.5, code=1, waiting_ms=0.6).stderr  # step 200 waited on both, step 100 on two threads
        self.assertIn("no step took 5 ms", said.splitlines()[-1])

    def test_bad_input_and_failures_are_one_line(self):
        self.check_least("--rounds", 3)
        self.check_status_refused()
        self.assertIn("exit code 1: cleave replay: no", self.run_it(code=1, stand_in_code=1).stderr.splitlines()[-1])
        self.assertFalse((self.directory / "out" / "modelled_workers.csv").exists())


class BusyMachineTest(Measurement):
    script = "busy_machine"

    def test_every_load_is_measured_in_every_round(self):
        result = self.run_it("--rounds", 2)
        rows = self.rows("busy_machine.csv")
        self.assertEqual([(row["round"], row["busy_loops"]) for row in rows],
                         [(number, loops) for number in "12" for loops in "012"])
        self.assertIn("2 busy loops: 4.0 ms, 1.00 of idle", result.stdout)
        self.assertIn("1.00 times as long beside 1 busy loop, 1.00 times as long beside 2 busy loops",
                      speed.busy_machine(self.stored()))

    def test_no_loop_outlives_a_failure(self):
        self.assertIn("exit code 1: cleave replay: no", self.run_it(code=1, stand_in_code=1).stderr.splitlines()[-1])
        self.assertEqual(len(self.calls()), 3)  # a record, a replay beside no loop, and the one beside a loop, which fails
        running = subprocess.run(["pgrep", "-f", f"busy_loop_for_{self.directory}/out"], capture_output=True, text=True,
                                 check=False)
        self.assertEqual(running.stdout, "")

    def test_bad_input_and_cells_that_are_not_solved_are_one_line(self):
        self.check_least("--rounds", 1)
        self.check_status_refused()


class IdleCostTest(Measurement):
    script = "idle_cost"

    def test_both_are_measured_in_turn_on_both_scenes(self):
        result = self.run_it("--rounds", 2)
        self.assertEqual(sum(call.startswith("replay") for call in self.calls()), 2 * 2 * 2)
        self.assertIn("large_rock_pile: 1.000 of the time", result.stdout)
        self.assertIn("chain_drop: 1.000 of the time", result.stdout)

    def test_bad_input_is_one_line(self):
        self.assertIn("--rounds is '0', expected a whole number from 1", self.run_it("--rounds", 0, code=1).stderr)


class DenseRatiosTest(unittest.TestCase):

    def entries(self):
        rates = {"peak:AVX2": 50, "cholesky:AVX2/1000": 40, "openblas/1000": 32, "cholesky_2/1000": 63,
                 "side_by_side/1000": 35, "inside/870": 38}
        return [{"name": name, "run_type": "iteration", "gflop_per_s": rate + spread}
                for name, rate in rates.items() for spread in (-5, 0, 20)]

    def test_shares_of_the_peak_and_of_what_two_threads_could_give(self):
        text = dense_ratios.markdown(self.entries())
        self.assertIn("| 1000 | 40.0 (80 %) | - | 32.0 | 1.25 | 63.0 | 70.0 | 0.90 |", text)
        self.assertIn("38.0 Gflop/s (870 interface rows", text)


class ColdStartsTest(Measurement):
    script = "cold_starts"

    def test_every_step_is_solved_cold_and_warm(self):
        self.run_it("--seeds", "4,5")
        calls = self.calls()
        self.assertEqual([("--cold" in call) for call in calls if call.startswith("replay")], [True, False] * 2)
        rows = self.rows("cold_starts.csv")
        self.assertEqual({row["seed"] for row in rows}, {"4", "5"})
        self.assertEqual({(row["factorizations_cold"], row["factorizations_warm"]) for row in rows}, {("9", "2")})
        self.assertIn("the 100 recorded steps", speed.cold_starts(self.stored()))

    def test_bad_input_and_cells_that_are_not_solved_are_one_line(self):
        self.assertIn("--seeds has 'x'", self.run_it("--seeds", "1,x", code=1).stderr)
        self.check_status_refused()


class KargerTest(Measurement):
    script = "karger"

    def test_every_scene_meets_every_number_of_trials(self):
        self.run_it()
        calls = self.calls()
        self.assertEqual(len(calls), 4 * 2)
        self.assertIn("karger@trials=10000", calls[-1])
        self.assertEqual(len(self.rows("karger.csv")), 4 * 4 * 7 * 2)

    def test_cells_that_are_not_solved_are_refused(self):
        with unittest.mock.patch.dict(os.environ, STAND_IN_STATUS="not_converged"):
            said = self.run_it(code=1).stderr.splitlines()
        self.assertIn("56 of 56 replayed cells are not ok", said[-1])
        self.assertFalse((self.directory / "out").exists())


class PartitionOverTimeTest(Measurement):
    script = "partition_over_time"

    def test_every_scene_meets_every_rule(self):
        self.run_it("--steps", 5)
        calls = self.calls()
        self.assertEqual(len(calls), 4 * 2 * 6)
        self.assertIn("--repartition drift:0.2", calls[-1])
        self.assertEqual(len(self.rows("partition_over_time.csv")), len(calls) * 4)  # the first step has no constraint

    def test_options(self):
        self.check_least("--steps", 1)


class PartitionWorthTest(Measurement):
    script = "partition_worth"

    def test_every_step_meets_every_solver_and_partition(self):
        self.run_it()
        self.assertEqual(len(self.calls()), 12 * (1 + 2))
        self.assertEqual(len(self.rows("partition_worth.csv")), 2 * 4 * (9 * 15 + 3 * (15 + 6) * 2))
        self.assertTrue((self.directory / "out" / "partition_worth.png").exists())
        self.assertIn("| rock pile, 50 bodies, 1200 rows, cfm 1e-05 | 8.10 (mindp, 10+fm) | 8.10 (mindp, 10+fm) | 8.10 (mindp, 10+fm) | "
                      "8.10 (mindp, 10+fm) | schur-rows, 1.98 | schur-rows, 7.36 | schur-rows, 7.36 |", worth.worth(self.stored()))

    def test_bad_input_is_one_line(self):
        self.check_least("--repeats", 1)


class PartitionRegretTest(Measurement):
    script = "partition_regret"

    def test_every_round_replays_every_cell_with_the_kernel_that_is_modelled(self):
        said = self.run_it("--rounds", 2, "--threads", 2).stdout
        self.assertEqual(said.count("pass"), 4 * 4, said)
        calls = self.calls()
        replays = [call.split() for call in calls if call.startswith("replay ")]
        self.assertEqual((len(calls), len(replays)), (4 * (1 + 2 * 4), 4 * 2 * 4))
        solvers = {kernel: f"pivot:{kernel},pivot:monolithic" for kernel in ("schur-rows", "schur-bodies", "schur-nested")} | {"any": "pivot:chosen,pivot:monolithic"}
        for words in replays:
            given = dict(zip(words, words[1:]))
            self.assertEqual(given["--solver"], solvers[given["--cost-kernel"]])
            self.assertEqual((given["--threads"], given["--cost-threads"]), ("2", "2"))
        rows = self.rows("partition_regret.csv")
        # scenes, steps and rounds; kernels, refiners, partitioners and solvers, of which the stand-in splits for both; chosen and monolithic
        self.assertEqual(len(rows), 4 * 12 * 2 * (3 * 2 * (5 + 3 * 5 + 1) * 2 + 2))
        self.assertEqual({row["replay"] for row in rows}, {"schur-rows", "schur-bodies", "schur-nested", "any"})
        self.assertEqual({row["round"] for row in rows}, {"1", "2"})

    def test_more_than_a_tenth_is_an_exit_code_and_said(self):
        for auto_ms, code in ((0.9, 3), (0.1, 0)):  # of 8.1
            with unittest.mock.patch.dict(os.environ, STAND_IN_AUTO_MS=str(auto_ms)):
                self.assertEqual(self.run_it("--rounds", 2, code=code).stdout.count("FAIL"), 16 if code else 0)

    def test_bad_input_is_one_line(self):
        self.check_least("--rounds", 2)


class PartitionWorthAnalysisTest(unittest.TestCase):

    def test_the_fastest_partition_counts_for_each_number_of_workers(self):
        def row(solver, partitioner, t_s_ms, model_ms, threads=1):
            return {"scene": "s", "bodies": 9, "cfm": 1e-5, "rows": 30, "solver": solver, "partitioner": partitioner, "refiner": "fm",
                    "threads": threads, "t_pr_ms": 1, "t_s_ms": t_s_ms, **{f"t_s_model_p{p}_ms": model_ms for p in partition_worth.MODELLED}}

        problem, = partition_worth.problems([row("a", "mix", 9, 4), row("a", "bfs", 7, 6), row("a", "mix", 5, 0, 2), row("b", "-", 4, 3.9)])
        self.assertEqual(problem.base_ms, 4)
        self.assertEqual((problem.best["a", 1].partition, problem.best["a", 8].partition), ("bfs+fm", "mix+fm"))
        self.assertEqual((problem.speed_up("a", 8), problem.measured["a"].time_ms), (4 / 5, 6))
        self.assertEqual((problem.winner(1), problem.winner(64)), ("b", "b"))

    def test_groups_are_held_against_parts_that_are_found(self):
        def row(scene, partitioner, t_s_ms, threads=1):
            return {"scene": scene, "bodies": 9, "cfm": 1e-5, "rows": 30, "solver": "a", "partitioner": partitioner, "refiner": "fm",
                    "threads": threads, "t_pr_ms": 1, "t_s_ms": t_s_ms, "parts": 3, "interface_rows": 12}

        found = partition_worth.kinds([row("s", "mix", 9), row("s", "bfs", 7), row("s", "semantic@split=whole", 5), row("s", "-", 1),
                                       row("s", "semantic@split=chunks@max-bodies=9", 4), row("s", "semantic@split=whole", 1, 2), row("t", "mix", 1)])
        (key, of_kind), = found.items()
        self.assertEqual(key[0][0], "s")
        self.assertEqual({kind: of.cell.time_ms for kind, of in of_kind.items()},
                         {partition_worth.FOUND: 8, partition_worth.WHOLE: 6, partition_worth.RUNS: 5})
        self.assertEqual(of_kind[partition_worth.FOUND].cell.partition, "bfs+fm")


class AblationTest(Measurement):
    script = "ablation"

    def test_every_scene_meets_every_choice(self):
        result = self.run_it()
        calls = self.calls()
        self.assertEqual(len(calls), 4 * (1 + len(cuts.CHOICES)))
        self.assertEqual(len(self.rows("ablation.csv")), 4 * len(cuts.CHOICES) * len(COMBINATIONS))
        self.assertIn("| mix+fm | 40 | 50 |  |  |  |", result.stdout)
        self.assertIn("| degree whole | `mix+none` | +25 % | +25 % | +25 % | +25 % |", cuts.ablation_facts(self.stored()))


# Writes what Google Benchmark would, of the rows that the scripts look at.
BENCHMARK = """#!/usr/bin/python3
import json, os, sys
with open(os.environ["STAND_IN_LOG"], "a") as log:
    log.write("benchmark " + " ".join(sys.argv[1:]) + "\\n")
path = next(word.partition("=")[2] for word in sys.argv if word.startswith("--benchmark_out="))
piles = [word.split("/")[-2] for word in sys.argv[1:] if word.endswith(".h5")]
rows = ["exact", "pgs:100", "pgs:300", "pgs:700", "cholmod:supernodal", "cholmod:simplicial", "factor", "assemble",
        "schur_bodies:1", "schur_bodies:2"]
json.dump({"benchmarks": [
    {"name": f"{row}/{pile}/x", "run_name": f"{row}/{pile}", "cpu_time": 1, "run_type": "iteration",
     "real_time": time + (8 if row == "exact" else 0), "rows": 1000, "factorizations": 5, "residual_m_per_s": 1e-12, "mflop": 6}
    for row in rows for pile in piles for time in (2, 2, 50)] + [
    {"name": "rocks_200/mix+fm/repeats:3", "run_name": "rocks_200/mix+fm", "cpu_time": time, "real_time": 3, "bodies": 200,
     "run_type": run_type}
    for time, run_type in ((1, "iteration"), (2, "iteration"), (9, "iteration"), (0.1, "aggregate"), (0.2, "aggregate"))]}, open(path, "w"))
"""


class BenchmarkCase(Measurement):
    program_name = None

    def setUp(self):
        super().setUp()
        beside = self.directory / "tests" / self.program_name
        beside.parent.mkdir()
        beside.write_text(BENCHMARK)
        beside.chmod(0o755)
        self.beside = beside


class SolverBenchmarkTest(BenchmarkCase):
    script, program_name = "benchmark_solvers", "solver_benchmark"

    def test_piles_are_recorded_anew_and_ratios_are_of_medians(self):
        for _ in range(2):
            result = self.run_it()
            self.assertEqual(len(self.calls()), 5 + 1)
        self.assertIn("| 200 rocks, cfm 1e-5 | 1000 | 10.00 | 5 | 1.0e-12 | 2.9 | 5.00 (100) | 5.0 | 3.0 | 1.0 | 1.00 | 1.00 |",
                      result.stdout)
        self.assertEqual(self.run_it("--print-only").stdout, result.stdout)
        self.check_least("--repetitions", 1)

    def test_a_benchmark_that_is_not_built(self):
        self.beside.unlink()
        self.assertIn("solver_benchmark is not built; run scripts/setup first", self.run_it(code=1).stderr)


class PartitionBenchmarkTest(BenchmarkCase):
    script, program_name = "benchmark_partitioners", "partition_benchmark"

    def test_steps_are_recorded_and_medians_written(self):
        self.run_it("--repetitions", 7)
        calls = self.calls()
        self.assertIn("--benchmark_repetitions=7", calls[-1])
        self.assertIn("/rocks_10000.h5", calls[-1])
        self.assertEqual(len(calls), 1 + calls[-1].count("--problem"))
        rows = json.loads((self.directory / "out" / "partition_benchmark.json").read_text())["benchmarks"]
        self.assertIn({"name": "rocks_200/mix+fm", "cpu_time": 2, "bodies": 200}, rows)

    def test_bad_input_is_one_line(self):
        self.check_least("--repetitions", 1)


class DenseBenchmarkTest(BenchmarkCase):
    script, program_name = "benchmark_dense", "dense_benchmark"

    def test_bad_input_is_one_line(self):
        self.check_least("--repetitions", 1)


if __name__ == "__main__":
    unittest.main()
