"""scripts/modelled_workers, cold_starts, ablation and the benchmarks with stand-ins for the programs they run."""
import csv
import json
import os
import pathlib
import subprocess
import tempfile
import unittest
import unittest.mock

import stored_data
from stand_in import StandInCase
from stored_data import write_csv
from synthetic import ROOT

from cleave_scripts.documents import cuts, speed, worth
from cleave_scripts.documents.stored import NoResults, Stored
from cleave_scripts.measurements import cut_ratios, dense_ratios, modelled_times, partition_worth
from cleave_scripts.results.paper import COMBINATIONS

STAND_IN = f"""#!/usr/bin/python3
import itertools, os, pathlib, sys
sys.path.insert(0, {str(ROOT / "tests" / "scripts")!r})
import stand_in_key
from synthetic import asked_partitioners, asked_refiners, write_manifest, write_steps
stand_in_key.answer()
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
    sys.exit(2 if "--advance" in words else 0)  # as steps that sweeps move are not exact
if words[0] == "run":
    given = dict(zip(words, words[1:]))
    write_steps(out, [dict(scene=given["--scene"], bodies=600, step=step, partitioner=given["--partitioner"],
                           refiner=given["--refiner"], repartition=given["--repartition"], partition_origin="fresh",
                           rows=1200 * step, interface_rows=40, parts=5,
                           t_pr_ms=0.1, t_s_ms=8) for step in range(int(given["--steps"]))])
    sys.exit(0)
files = [word for word in words if word.endswith(".h5")]
assert files and all(os.path.exists(file) for file in files), files
def recorded(file):
    asked = pathlib.Path(file).read_text().split()
    asked = dict(zip(asked, asked[1:]))
    return dict(scene=asked["--scene"], bodies=asked.get("--bodies", 600), cfm=float(asked.get("--cfm", 1e-5)),
                step=int(file[-9:-3]))
beside = out.name == "replay1"  # the second of two at the same time
threads = int(words[words.index("--threads") + 1]) if "--threads" in words else 1
given = dict(zip(words, words[1:]))
def alone_ms(step):
    alone = float(os.environ.get("STAND_IN_MS", 8)) if step == 100 else 8
    return alone * (float(os.environ.get("STAND_IN_BESIDE", 1)) if beside else 1)
def apart_ns(threads, solver):
    return float(os.environ.get("STAND_IN_APART", 100) if threads > 1 and solver == "exact" else "nan")
def modelled(step, threads):
    # As measured, but for step 100 as the test says.
    two = alone_ms(step) / 2 * (float(os.environ.get("STAND_IN_MODEL", 1)) if step == 100 else 1)
    of_workers = [f"t_s_model_p{{p}}_ms" for p in (4, 8, 16, 32, 64)]
    more = {{name: alone_ms(step) / 8 for name in ("t_s_critical_path_ms", *of_workers)}}
    return {{"t_s_model_p2_ms": two, **more}} if threads == 1 else dict.fromkeys(("t_s_model_p2_ms", *more), float("nan"))
names = list(itertools.product(asked_partitioners(given.get("--partitioner", "-")),
                               asked_refiners(given.get("--refiner", "-"))))
whole = ("pivot:monolithic", "auto:monolithic")  # ignore parts
path = write_steps(out, [dict(**recorded(file), partitioner="-" if solver in whole else partitioner,
                       refiner="-" if solver in whole else refiner, threads=threads, rows=1200,
                       interface_rows=0 if partitioner == "single" else 50 if "whole" in words else 40,
                       parts=1 if partitioner == "single" else 5,
                       status=os.environ.get("STAND_IN_STATUS", "not_converged" if "@sweeps" in solver else "ok"),
                       t_s_ms=alone_ms(int(file[-9:-3])) / threads,
                       t_s_waiting_ms=float(os.environ.get("STAND_IN_WAITING", 0.25)),
                       core_round_trip_ns=apart_ns(threads, solver),
                       factorizations=9 if "--cold" in words else 2, seed=1, solver=solver,
                       t_pr_ms=float(os.environ.get("STAND_IN_AUTO_MS", 0.1)) if partitioner == "auto" else 0.1,
                       calibration="-", auto_choice="-",
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
        self.check_refused(((option, least - 1),
                            f"{option} is '{least - 1}', expected a whole number from {least} to 999999999; see"),
                           ((option, "x"), f"{option} is 'x', expected a whole number from {least} to"))


class ModelledWorkersTest(Measurement):
    script = "modelled_workers"
    cells = 5 * 2 * 4 + 2 * 1 * 2  # problems, steps, solvers; and those of 10000 rocks

    def model(self, share, code=0, ms=20, waiting_ms=0.1):
        """Step 100 takes ms on one thread and half of it on two, which the model gives times share; step 200 takes 8 ms."""
        with unittest.mock.patch.dict(os.environ, STAND_IN_MODEL=str(share), STAND_IN_MS=str(ms),
                                      STAND_IN_WAITING=str(waiting_ms)):
            return self.run_it("--rounds", 3, code=code)

    def test_one_and_two_threads_take_turns_on_the_same_files(self):
        self.model(1)
        calls = self.calls()
        records, replays = ([call for call in calls if call.startswith(word)] for word in ("record", "replay"))
        self.assertEqual([" --advance pgs@sweeps=30 " in call for call in records], [False] * 5 + [True] * 2)
        self.assertEqual([call.partition(" --cfm")[0] for call in records[5:]],
                         ["record --scene rock_pile --at 150 --bodies 10000"] * 2)
        told = [call.partition(".h5 --solver ")[2].partition(" --partitioner mix --refiner fm --repeats ") for call in replays]
        self.assertEqual({solvers for solvers, *_ in told[::2]}, {"exact,schur,pivot:schur-bodies,pivot:schur-nested"})
        self.assertEqual({solvers for solvers, *_ in told[1::2]}, {"exact,pivot:schur-nested"})
        self.assertEqual([rest.partition(" --out")[0] for *_, rest in told],
                         [f"{repeats} --threads {threads}" for threads in (1, 2, 2, 1, 1, 2) for repeats in (3, 3)])
        rows = self.rows("modelled_workers.csv")
        self.assertEqual(len(rows), 3 * 2 * self.cells)
        self.assertEqual({(row["task_us"], row["stage_us"]) for row in rows}, {("0.2", "1.5")})

    def test_the_error_of_slow_steps_decides_and_all_others_are_shown(self):
        said = self.model(0.9).stdout
        self.assertIn("Steps of 5 ms and more on two threads: 20, median error 10.0 %, from -10 to -10 %; with medians over",
                      said)
        self.assertIn("| rock_pile | 200 | 1e-05 | 100 | exact | 20.0 | 9.00 | 10.0 | -10 % | 2.50 | 2.50 | 2.50 |", said)
        self.assertIn("Steps below 5 ms: 24, median error 0.0 %", said)
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

    def test_speed_ups_are_of_the_fastest_solver_on_one_thread_and_of_the_least_that_is_modelled(self):
        def step(bodies, solver, one_ms, modelled_ms, number=1):
            return modelled_times.Step(("s", str(bodies), "1e-05", str(number), solver), one_ms, one_ms / 2, one_ms / 2,
                                       [modelled_ms, 1, 1], 0)
        steps = [step(600, "exact", 20, 4), step(600, "schur", 24, 2), step(600, "nested", 30, 3), step(200, "exact", 9, 1),
                 step(600, "exact", 12, 2, number=2), step(10000, "exact", 90, 10)]
        found = modelled_times.speed_ups(steps)
        self.assertEqual([(one.one.solver, one.modelled.solver, one.ratio, one.asked) for one in found],
                         [("exact", "schur", 10, 6), ("exact", "exact", 6, 6), ("exact", "exact", 9, 10)])
        told = modelled_times.lines_of_speed_ups(steps)
        self.assertIn("| s | 600 | 1e-05 | 2 | 12.0 (`exact`) | 2.00 (`exact`) | 6.00 | 6, holds |\n"
                      "| s | 10000 | 1e-05 | 1 | 90.0 (`exact`) | 10.0 (`exact`) | 9.00 | 10, does not hold |", told)
        self.assertEqual(modelled_times.lines_of_speed_ups(steps[3:4]), "")

    def test_the_document_says_the_same(self):
        self.assertIn("| rock_pile | 600 | 1e-05 | 200 | 8.00 (`exact`) | 1.00 (`exact`) | 8.00 | 6, holds |\n",
                      self.model(0.9).stdout)
        made = speed.modelled_workers(self.stored())
        self.assertIn("the fastest of 3 rounds, seed 1, `mix+fm`", made)
        self.assertIn("| rock_pile | 200 | 1e-05 | 100 | exact | 20.0 | 9.00 | 10.0 | -10 % |", made)
        self.assertIn("| rock_pile | 10000 | 1e-10 | 150 | 8.00 (`exact`) | 1.00 (`exact`) | 8.00 | 10, does not hold |", made)

    def test_without_slow_steps_or_a_core_nothing_is_decided(self):
        self.assertIn("no step took 5 ms", self.model(1, code=1, ms=9).stderr.splitlines()[-1])
        said = self.model(0.5, code=1, waiting_ms=1.1).stderr  # all waited
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
        self.assertIn("1.00 times as long as with threads that never sleep on large rock pile and 1.00 times",
                      speed.idle_cost(self.stored()))

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


class CutTargetsTest(unittest.TestCase):
    """On three graphs METIS cuts 500 rows."""

    def holds(self, change=None):
        with tempfile.TemporaryDirectory() as directory:
            stored_data.partition_benchmark(pathlib.Path(directory))
            rows = json.loads((pathlib.Path(directory) / "partition_benchmark.json").read_text())["benchmarks"]
        for row in rows if change else ():
            change(row)
        return {asked.split(":")[0]: yes for asked, yes in cut_ratios.targets(cut_ratios.by_graph(rows))}

    def failed(self, name, **changed):
        """What does no longer hold where this is so of one graph, the second."""
        def change(row):
            if row["name"] == f"pile_1000/{name}":
                row.update(changed)
        now, before = self.holds(change), self.holds()
        return [asked for asked in before if before[asked] and not now[asked]]

    def test_what_holds(self):
        self.assertEqual([asked for asked, yes in self.holds().items() if not yes],
                         ["mix+fm, mended, is within 15 % of the best peer in the mean", "mix+fm, mended, on every graph too"])

    def test_each_is_seen_to_fail(self):
        best, fast = "multilevel@effort=best+none", "multilevel@effort=fast+none"
        self.assertEqual(self.failed(best, interface_rows=560), ["on no graph more than 10 % or 12 rows more"])
        self.assertIn("`effort=best` cuts at most what the best peer cuts, in the mean", self.failed(best, interface_rows=5000))
        self.assertEqual(self.failed(best, cpu_time=101e3), ["and is no slower than METIS recursive"])
        self.assertEqual(self.failed(fast, cpu_time=21e3),
                         ["`effort=fast` is at least 5 times as fast as METIS recursive on graphs of 200 to 10000 bodies"])
        self.assertEqual(self.failed(fast, interface_rows=600),
                         ["with at most 1.05 times its rows in the mean", "and on every one of these graphs"])
        self.assertEqual(self.failed(fast, cpu_time=4e3), ["a body takes at most 3 times as long at 100000 as at 1000"])
        self.assertEqual(self.failed("mindp@merge-small=true+fm", interface_rows=800),
                         ["mindp+fm, mended, is within 15 % of the best peer in the mean",
                          "mindp+fm, mended, on every graph too"])


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
        self.assertEqual(len(calls), 7 * 2)
        self.assertIn("--scene crane --at 100,200,300,400 --dt 0.001 --cfm 1e-10", calls[-4])
        self.assertIn("karger@trials=10000,karger@karger-method=recursive-bisection@trials=1 ", calls[-1])
        self.assertEqual(len(self.rows("karger.csv")), 7 * 4 * 8 * 2)

    def test_cells_that_are_not_solved_are_refused(self):
        with unittest.mock.patch.dict(os.environ, STAND_IN_STATUS="not_converged"):
            said = self.run_it(code=1).stderr.splitlines()
        self.assertIn("64 of 64 replayed cells are not ok", said[-1])
        self.assertFalse((self.directory / "out").exists())


class PartitionOverTimeTest(Measurement):
    script = "partition_over_time"

    def test_every_scene_meets_every_rule(self):
        self.run_it("--steps", 5)
        calls = self.calls()
        self.assertEqual(len(calls), 7 * 2 * 6)
        self.assertIn("--repartition drift:0.2", calls[-1])
        self.assertEqual(len(self.rows("partition_over_time.csv")), len(calls) * 4)  # the first step has no constraint

    def test_options(self):
        self.check_least("--steps", 1)


class PartitionWorthTest(Measurement):
    script = "partition_worth"

    def test_every_round_replays_every_step_with_every_solver_and_partition_in_another_order(self):
        self.run_it("--rounds", 2)
        replays = [call.split() for call in self.calls() if call.startswith("replay ")]
        of_round = len(replays) // 2
        self.assertEqual(of_round, 2 * (10 * 4 + 2 + 3 * 4))  # threads; cases, replays of each
        given = [dict(zip(words, words[1:])) for words in replays]
        self.assertTrue(all("single" in of["--partitioner"].split(",") and of["--solver"].endswith(",auto:monolithic")
                            for of in given))
        self.assertEqual([[of["--threads"] for of in of_half[:5]] for of_half in (given[:of_round], given[of_round:])],
                         [["1"] * 4 + ["2"], ["2"] * 4 + ["1"]])
        first, second = (next(of for of in of_half if "mix" in of["--partitioner"])
                         for of_half in (given[:of_round], given[of_round:]))
        for option in ("--partitioner", "--solver"):
            self.assertNotEqual(first[option], second[option])
            self.assertEqual(sorted(first[option].split(",")), sorted(second[option].split(",")))
        rows = self.rows("partition_worth.csv")
        # rounds and threads; solvers of cases, replays and partitioners; the large pile; mechanisms with two refiners
        self.assertEqual(len(rows), 2 * 2 * (4 * 10 * 4 * 6 + 3 * 2 * 6 + 4 * 3 * (7 + 3 * 6) * 2))
        self.assertEqual({row["round"] for row in rows}, {"1", "2"})
        self.assertEqual({row["replay"] for row in rows}, {"mindp", "mix", "multilevel", "metis-recursive", "semantic"})
        self.assertTrue((self.directory / "out" / "partition_worth.png").exists())
        made = worth.worth(self.stored())
        undecided = "undecided: whole system, schur-rows, schur-bodies or schur-nested"
        self.assertRegex(made, r"\| rock pile, 50 bodies, 1200 rows, cfm 1e-05( \| 8.10 \(\w+, [\w, ]+\+fm\)){3} \| 8.00 "
                         rf"\| {undecided} \| {undecided}, 2.00 \| whole system, 8.00 \| whole system, 8.00 \|")
        self.assertIn("off by 0.0 % in the median", made)

    def test_bad_input_is_one_line(self):
        self.check_least("--rounds", 2)
        self.check_least("--repeats", 1)


class PartitionRegretTest(Measurement):
    script = "partition_regret"

    def test_every_round_replays_every_cell_with_the_kernel_that_is_modelled(self):
        said = self.run_it("--rounds", 2, "--threads", 2).stdout
        self.assertEqual(said.count("pass"), 7 * 4, said)
        calls = self.calls()
        replays = [call.split() for call in calls if call.startswith("replay ")]
        self.assertEqual((len(calls), len(replays)), (7 * (1 + 2 * 4), 7 * 2 * 4))
        solvers = {kernel: f"pivot:{kernel},pivot:monolithic"
                   for kernel in ("schur-rows", "schur-bodies", "schur-nested")} | {"any": "pivot:chosen,pivot:monolithic"}
        for words in replays:
            given = dict(zip(words, words[1:]))
            self.assertEqual(given["--solver"], solvers[given["--cost-kernel"]])
            self.assertEqual((given["--threads"], given["--cost-threads"]), ("2", "2"))
        rows = self.rows("partition_regret.csv")
        # scenes, steps and rounds; kernels, refiners, partitioners and solvers, of which the stand-in splits for both;
        # chosen and monolithic
        self.assertEqual(len(rows), 7 * 12 * 2 * (3 * 2 * (5 + 3 * 5 + 1) * 2 + 2))
        self.assertEqual({row["replay"] for row in rows}, {"schur-rows", "schur-bodies", "schur-nested", "any"})
        self.assertEqual({row["round"] for row in rows}, {"1", "2"})

    def test_more_than_a_tenth_is_an_exit_code_and_said(self):
        for auto_ms, code in ((0.9, 3), (0.1, 0)):  # of 8.1
            with unittest.mock.patch.dict(os.environ, STAND_IN_AUTO_MS=str(auto_ms)):
                self.assertEqual(self.run_it("--rounds", 2, code=code).stdout.count("FAIL"), 28 if code else 0)

    def test_bad_input_is_one_line(self):
        self.check_least("--rounds", 2)


def worth_rows(solver, partitioner, times, model_ms=1, threads=1, **changes):
    """times: t_s in ms a round, from round 1; without t_pr."""
    return [{"scene": "s", "bodies": 9, "cfm": 1e-5, "step": 2, "rows": 30, "solver": f"auto:{solver}",
             "partitioner": partitioner, "refiner": "-" if partitioner == "-" else "fm", "parts": 3, "interface_rows": 12,
             "threads": threads, "t_pr_ms": 0, "t_s_ms": t_s_ms,
             **{f"t_s_model_p{p}_ms": model_ms for p in partition_worth.MODELLED}, "round": number, "replay": "one", **changes}
            for number, t_s_ms in enumerate(times, 1)]


def whole_rows(times, **changes):
    return worth_rows("monolithic", "-", times, **{"parts": -1, "interface_rows": -1, **changes})


class PartitionWorthAnalysisTest(unittest.TestCase):

    def problem(self, *series, two=()):
        rows = sum(series,
                   whole_rows([10] * 4) if not any(of[0]["solver"] == partition_worth.WHOLE_SYSTEM for of in series) else [])
        (problem,) = partition_worth.problems(rows + sum(two, whole_rows([10] * 4, threads=2)))
        return problem

    def table_row(self, *series, two=()):
        """The cells of the generated table, less the problem."""
        with tempfile.TemporaryDirectory() as scratch:
            root = pathlib.Path(scratch)
            write_csv(root / "partition_worth.csv",
                      sum(series, whole_rows([10] * 4)) + sum(two, whole_rows([10] * 4, threads=2)))
            return worth.worth(Stored(root)).split("\n\n")[1].splitlines()[-1].strip("| ").split(" | ")[1:]

    def test_the_odd_rounds_choose_the_partition_and_the_even_ones_tell_its_time(self):
        cells = self.problem(worth_rows("schur-rows", "mix", [5, 9, 5, 8]),
                             worth_rows("schur-rows", "bfs", [6, 1, 6, 1])).best[1]
        self.assertEqual((cells["auto:schur-rows"].partition, cells["auto:schur-rows"].time_ms), ("mix+fm", 8.5))
        self.assertEqual(self.problem(worth_rows("schur-rows", "mix", [5, 90, 7, 90])).best[1]["auto:schur-rows"].chosen_ms, 6)
        self.assertEqual(self.problem(worth_rows("schur-rows", "mix", [5, 9, 5, 8]),
                                      worth_rows("schur-bodies", "mix", [6, 1, 6, 1])).base_ms, 8.5)

    def test_the_fastest_partition_counts_for_each_number_of_workers(self):
        problem = self.problem(worth_rows("schur-rows", "mix", [9] * 4, 4, t_pr_ms=1),
                               worth_rows("schur-rows", "bfs", [7] * 4, 6, t_pr_ms=1), whole_rows([4] * 4, model_ms=3.9),
                               two=[worth_rows("schur-rows", "mix", [5] * 4, 0, 2, t_pr_ms=1)])
        self.assertEqual(problem.base_ms, 4)
        self.assertEqual([problem.best[workers]["auto:schur-rows"].partition for workers in (1, 8)], ["bfs+fm", "mix+fm"])
        self.assertEqual((problem.speed_up(problem.best[8]["auto:schur-rows"]), problem.measured["auto:schur-rows"].time_ms),
                         (4 / 5, 6))
        self.assertEqual([partition_worth.fastest(problem.best[workers]) for workers in (1, 64)],
                         [[partition_worth.WHOLE_SYSTEM]] * 2)

    def test_times_are_put_at_the_pace_of_the_whole_system_in_the_same_replay(self):
        # The second replay of the first round is half as fast as all others.
        replays = [whole_rows([10] * 4), worth_rows("schur-rows", "mix", [8] * 4),
                   whole_rows([20, 10, 10, 10], replay="two"), worth_rows("schur-rows", "bfs", [14, 7, 7, 7], replay="two")]
        cells = self.problem(*replays).best[1]
        self.assertEqual((cells["auto:schur-rows"].partition, cells["auto:schur-rows"].chosen_ms), ("bfs+fm", 7))
        self.assertEqual(cells[partition_worth.WHOLE_SYSTEM].time_ms, 10)

    def test_one_solve_that_was_held_up_does_not_make_the_pace(self):
        one_part = [worth_rows(kernel, "single", [10] * 4, parts=1, interface_rows=0)
                    for kernel in ("schur-rows", "schur-bodies", "schur-nested")]
        cells = self.problem(whole_rows([10, 10, 10, 30]), *one_part, worth_rows("schur-rows", "mix", [9] * 4)).best[1]
        self.assertEqual(cells["auto:schur-rows"].told_ms, (9, 9))

    def test_what_cuts_nothing_is_the_whole_system_whichever_kernel_solved_it(self):
        one_part = worth_rows("schur-rows", "single", [5] * 4, parts=1, interface_rows=0)
        apart = worth_rows("schur-bodies", "mix", [4] * 4, parts=2, interface_rows=0)
        cut = worth_rows("schur-rows", "mix", [8] * 4)
        cells = self.problem(one_part, cut).best[1]
        self.assertEqual({kernel: cell.time_ms for kernel, cell in cells.items()},
                         {"auto:schur-rows": 8, partition_worth.WHOLE_SYSTEM: 5})
        self.assertEqual(self.table_row(one_part, cut)[:5],
                         ["8.00 (mix+fm)", "-", "-", "5.00 (schur-rows, single+fm: one part)", "whole system"])
        self.assertEqual(self.table_row(apart, cut)[3:5],
                         ["4.00 (schur-bodies, mix+fm: 2 parts, 0 interface rows)", "whole system"])
        two = [worth_rows("schur-rows", "single", [5] * 4, threads=2, parts=1, interface_rows=0)]
        self.assertEqual(self.table_row(one_part, cut, two=two)[5], "whole system, 1.00")

    def fastest(self, *times):
        """Of kernels with these times beside a whole system that takes 10 ms."""
        kernels = ("schur-rows", "schur-bodies", "schur-nested")
        found = partition_worth.fastest(self.problem(*(worth_rows(kernel, "mix", of)
                                                       for kernel, of in zip(kernels, times))).best[1])
        return [name.removeprefix("auto:") for name in found]

    def test_a_lead_is_one_in_every_even_round_and_of_what_is_first_in_the_odd_ones(self):
        self.assertEqual(self.fastest([9, 9, 9, 9]), ["schur-rows"])
        self.assertEqual(self.fastest([9, 9, 9, 10.1]), ["schur-rows", "monolithic"])  # one sign it does not keep
        self.assertEqual(self.fastest([9, 9.8, 9, 9]), ["schur-rows", "monolithic"])  # by less than 3 % once
        self.assertEqual(self.fastest([10.5, 9, 10.5, 9]), ["schur-rows", "monolithic"])  # not first by the odd rounds
        self.assertEqual(self.fastest([9, 12, 9, 12]), ["monolithic", "schur-rows"])  # and no longer by the even ones
        self.assertEqual(self.fastest([8, 8, 8, 8], [7.9, 8.1, 7.9, 8.1], [9, 9, 9, 9]), ["schur-rows", "schur-bodies"])

    def test_the_share_of_partitioning_is_of_the_papers_kernel_and_of_the_fastest(self):
        mix = "mix@max-bodies=25"
        with tempfile.TemporaryDirectory() as scratch:
            root = pathlib.Path(scratch)
            write_csv(root / "partition_worth.csv", whole_rows([10] * 4)
                      + worth_rows("schur-rows", mix, [20, 20, 20, 90], t_pr_ms=0.1)
                      + worth_rows("schur-bodies", mix, [4] * 4, t_pr_ms=0.1)
                      + worth_rows("schur-nested", mix, [5] * 4, t_pr_ms=1)
                      + worth_rows("schur-rows", "mix@max-bodies=50", [1] * 4, t_pr_ms=9))
            made = worth.partition_share(Stored(root))
        self.assertIn("| s, 9 bodies, 30 rows, cfm 1e-05 | - | 0.5 / 2.5 | - |", made)
        self.assertIn("aimed at are 1 % and 5 %, which 1 and 1 of 1 cells keep", made)

    def test_what_is_not_decided_is_told_so(self):
        row = self.table_row(worth_rows("schur-bodies", "mix", [9, 9, 9, 10.1], model_ms=0.5))
        self.assertEqual(row[4], "undecided: schur-bodies or whole system")
        self.assertEqual(row[6], "schur-bodies, 19.1")
        self.assertEqual(self.table_row(worth_rows("schur-bodies", "mix", [9] * 4))[4], "schur-bodies")

    def test_groups_are_held_against_parts_that_are_found(self):
        def series(partitioner, t_s_ms, **changes):
            return worth_rows("schur-rows", partitioner, [t_s_ms] * 4, t_pr_ms=1, **changes)

        rows = (series("mix", 9) + series("bfs", 7) + series("semantic@split=whole", 5) +
                whole_rows([1] * 4) + whole_rows([1] * 4, threads=2) +
                series("semantic@split=chunks@max-bodies=9", 4) + series("semantic@split=whole", 1, threads=2) +
                series("single", 3, parts=1, interface_rows=0) + series("mix", 1, scene="t") + whole_rows([1] * 4, scene="t"))
        (key, of_kind), = partition_worth.kinds(rows).items()
        self.assertEqual(key[0][0], "s")
        self.assertEqual({kind: of.time_ms for kind, of in of_kind.items()},
                         {partition_worth.FOUND: 8, partition_worth.WHOLE: 6, partition_worth.RUNS: 5,
                          partition_worth.UNCUT: 4})
        self.assertEqual(of_kind[partition_worth.FOUND].partition, "bfs+fm")
        with tempfile.TemporaryDirectory() as scratch:
            write_csv(pathlib.Path(scratch) / "partition_worth.csv", rows)
            made = worth.semantic(Stored(scratch))
        self.assertIn("| 5.00 (semantic, chunks, 9+fm: 3 parts, 12 interface rows) | "
                      "8.00 (bfs+fm: 3 parts, 12 interface rows) | 4.00 (single+fm: one part) | nothing cut |", made)

    def test_the_model_of_two_workers_is_held_against_two_threads(self):
        rows = (worth_rows("schur-rows", "mix", [9] * 4, 4) + whole_rows([10] * 4, model_ms=9) +
                worth_rows("schur-rows", "mix", [6, 4, 4, 10, 10], threads=2) +
                whole_rows([8, 8, 8, 16, 16], threads=2))  # two at half the pace
        self.assertEqual([(item.measured_ms, round(item.error, 6), item.slow) for item in partition_worth.model_errors(rows)],
                         [(5, -0.2, True), (8, 0.125, True)])
        with tempfile.TemporaryDirectory() as scratch:
            write_csv(pathlib.Path(scratch) / "partition_worth.csv", rows)
            self.assertIn("of 2 cells: the model is off by 16.2 % in the median, by 16.2 % of the 2 that take 5 ms and more, "
                          "and too low in 50 % of all.", worth.worth(Stored(scratch)))

    def test_rows_of_no_rounds_are_no_measurement(self):
        with tempfile.TemporaryDirectory() as scratch:
            write_csv(pathlib.Path(scratch) / "partition_worth.csv",
                      [{name: value for name, value in row.items() if name not in ("round", "replay")}
                       for row in whole_rows([10])])
            for make in (worth.worth, worth.semantic):
                with self.assertRaisesRegex(NoResults,
                                            "tells no noise, as each cell was timed once: `scripts/partition_worth` makes"):
                    make(Stored(scratch))


class AblationTest(Measurement):
    script = "ablation"

    def test_every_scene_meets_every_choice(self):
        result = self.run_it()
        calls = self.calls()
        self.assertEqual(len(calls), 4 * (1 + len(cuts.CHOICES)))
        self.assertEqual(len(self.rows("ablation.csv")), 4 * len(cuts.CHOICES) * len(COMBINATIONS))
        self.assertIn("| mix+fm | 40 | 50 |  |  |  |", result.stdout)
        self.assertIn("| degree whole | `mix+none` | +25 % | +25 % | +25 % | +25 % |", cuts.ablation_facts(self.stored()))

    def test_a_cell_that_was_not_solved_is_no_mean(self):
        with unittest.mock.patch.dict(os.environ, STAND_IN_STATUS="not_converged"):
            said = self.run_it(code=1).stderr.splitlines()
        self.assertRegex(said[-1], r"replayed cells are not ok, first: step 50, \S+ \S+: status not_converged")
        self.assertFalse((self.directory / "out").exists())


# Writes what Google Benchmark would, of the rows that the scripts look at.
BENCHMARK = f"""#!/usr/bin/python3
import sys
sys.path.insert(0, {str(ROOT / "tests" / "scripts")!r})
import stand_in_key
""" + """
import json, os
with open(os.environ["STAND_IN_LOG"], "a") as log:
    log.write("benchmark " + " ".join(sys.argv[1:]) + "\\n")
path = next(word.partition("=")[2] for word in sys.argv if word.startswith("--benchmark_out="))
piles = [word.split("/")[-2] for word in sys.argv[1:] if word.endswith(".h5")]
rows = ["exact", "pgs:100", "pgs:300", "pgs:700", "cholmod:supernodal", "cholmod:simplicial", "factor", "assemble",
        "schur_bodies:1", "schur_bodies:2"]
context = {name: value for name, value in stand_in_key.key(sys.argv).items() if name.startswith("git_")}
context |= json.loads(os.environ.get("STAND_IN_CONTEXT", "{}"))
json.dump({"context": {"executable": sys.argv[0], **context}, "benchmarks": [
    {"name": f"{row}/{pile}/x", "run_name": f"{row}/{pile}", "cpu_time": 1, "run_type": "iteration",
     "real_time": time + (8 if row == "exact" else 0), "rows": 1000, "factorizations": 5, "residual_m_per_s": 1e-12, "mflop": 6}
    for row in rows for pile in piles for time in (2, 2, 50)] + [
    {"name": "rocks_200/mix+fm/repeats:3", "run_name": "rocks_200/mix+fm", "cpu_time": time, "real_time": 3, "bodies": 200,
     "run_type": run_type}
    for time, run_type in ((1, "iteration"), (2, "iteration"), (9, "iteration"), (0.1, "aggregate"), (0.2, "aggregate"))
    ]}, open(path, "w"))
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

    def check_other_builds_refused(self):
        """One line, and what an earlier run has left stays."""
        path = self.directory / "out" / f"{self.program_name}.json"
        path.parent.mkdir()
        path.write_text("earlier")
        for context, words in (({"git_hash": "f" * 40},
                                "ffffffffff (local changes: false) and 0123456789 (local changes: false)"),
                               ({"git_dirty": "true"},
                                "0123456789 (local changes: true) and 0123456789 (local changes: false)"),
                               ({"git_hash": "unknown"}, "unknown (local changes")):
            with unittest.mock.patch.dict(os.environ, STAND_IN_CONTEXT=json.dumps(context)):
                said = self.run_it(code=1).stderr.splitlines()[-1]
            self.assertIn(f": {self.beside} and {self.program} are builds of commits {words}", said)
            self.assertEqual(path.read_text(), "earlier")


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

    def test_a_benchmark_of_another_build_is_refused(self):
        self.check_other_builds_refused()


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

    def test_a_benchmark_of_another_build_is_refused(self):
        self.check_other_builds_refused()


class DenseBenchmarkTest(BenchmarkCase):
    script, program_name = "benchmark_dense", "dense_benchmark"

    def test_a_benchmark_of_another_build_is_refused(self):
        self.check_other_builds_refused()

    def test_bad_input_is_one_line(self):
        self.check_least("--repetitions", 1)


if __name__ == "__main__":
    unittest.main()
