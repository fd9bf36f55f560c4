"""scripts/large_scenes: its own count of a factorisation, what is made of its rows, and the command with stand-ins."""
import csv
import os
import pathlib
import tempfile
import unittest
import unittest.mock

import numpy
import stored_data
from stand_in import NOTES_ITS_CALL, StandInCase
from synthetic import PROGRAM, ROOT

from cleave_scripts.documents import large
from cleave_scripts.documents.stored import Stored
from cleave_scripts.measurements import large_scenes
from cleave_scripts.measurements.dissection import Graph, dissection_mflop, factor_mflop, graph_of, order_by_metis
from cleave_scripts.results.programs import record, replay


def grid(width):
    """Every node of a square and its neighbours in x and y."""
    node = numpy.arange(width * width).reshape(width, width)
    return Graph(width * width, numpy.concatenate([numpy.stack([node[:-1], node[1:]], -1).reshape(-1, 2),
                                                   numpy.stack([node[:, 1:], node[:, :-1]], -1).reshape(-1, 2)]))


def counted_densely(graph, order):
    """Sum of squared column counts, by eliminating in a matrix that says where something is not zero."""
    full = numpy.eye(graph.body_count, dtype=bool)
    for body in range(graph.body_count):
        full[body, graph.neighbours(body)] = True
    full = numpy.kron(full[numpy.ix_(order, order)], numpy.ones((6, 6), dtype=bool))
    flops = 0
    for column in range(len(full)):
        below = numpy.flatnonzero(full[column + 1:, column]) + column + 1
        full[numpy.ix_(below, below)] = True
        flops += (len(below) + 1)**2
    return 1e-6 * flops


class DissectionTest(unittest.TestCase):

    def test_pairs_count_once_and_in_both_directions(self):
        graph = Graph(4, numpy.array([[2, 0], [0, 2], [1, 2]]))
        self.assertEqual([list(graph.neighbours(body)) for body in range(4)], [[2], [2], [0, 1], []])

    def test_arithmetic_is_that_of_an_elimination_in_any_order(self):
        graph = grid(5)
        for order in (numpy.arange(25), numpy.random.default_rng(1).permutation(25), order_by_metis(graph)):
            self.assertAlmostEqual(factor_mflop(graph, order), counted_densely(graph, order), places=9)

    def test_the_order_holds_every_body_once_and_saves(self):
        graph = grid(30)
        order = order_by_metis(graph)
        self.assertEqual(sorted(order), list(range(900)))
        self.assertLess(factor_mflop(graph, order), 0.5 * factor_mflop(graph, numpy.arange(900)))

    def test_the_program_counts_alike(self):
        """In the only order of fill that two boxes have, and in nested dissection, which it takes of so many."""
        for bodies in (2, 2000):
            with tempfile.TemporaryDirectory() as scratch:
                file, = record(PROGRAM, pathlib.Path(scratch) / "steps", "silo", [2], "--bodies", bodies,
                               "--advance", "pgs@sweeps=30", all_ok=False)
                row, = replay(PROGRAM, pathlib.Path(scratch) / "replay", [file], "--solver", "exact", "--repeats", 1)
                self.assertEqual(graph_of(file).body_count, bodies)
                self.assertAlmostEqual(dissection_mflop(file) / row.number("factor_mflop_local"), 1,
                                       places=1 if bodies > 2 else 9)


class TablesTest(unittest.TestCase):

    def told(self, rows):
        root = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        stored_data.write_csv(root / "large_scenes.csv", rows)
        stored_data.write_provenance(root, "large_scenes.csv")
        return large.large_scenes(Stored(root))

    def test_ratios_are_of_one_round_and_medians_over_them(self):
        told = self.told(stored_data.large_scenes_rows())
        self.assertIn("medians of 3 replays", told)
        self.assertIn("Solves that waited more than 5 % of t_s a thread for a core are left out: 0.", told)
        self.assertIn("| 10000 | 1 | 100000 | 5 | 0.0200 | 850 | 1.70 | 1.00 | 850 | 0.20 | "
                      "at most 90 sweeps: does not hold |\n"
                      "| 10000 | 2 | 100000 | 5 | 0.0200 | 500 | 1.00 | 1.00 | - | 0.20 | - |\n"
                      "| 100000 | 1 | 1000000 | 10 | 0.00200 | 28900 | 2.89 | 1.70 | 2890 | 2.00 | "
                      "at most 1.6 times the smallest: does not hold |\n"
                      "| 100000 | 2 | 1000000 | 10 | 0.00200 | 15000 | 1.50 | 1.50 | - | 2.00 | "
                      "at most 1.6 times the smallest: holds |\n", told)
        self.assertIn("| 10000 | 1 | 300000 | 4 | 900 | 1.10 | 1.10 | 40.0 | 50.0 | 80 % | holds |\n"
                      "| 10000 | 2 | 300000 | 4 | 600 | 1.10 | 1.10 | 80.0 | 100 | 80 % | holds |", told)

    def test_what_was_asked_is_held_against_values_that_are_not_rounded(self):
        def changed(row):
            if row["solver"] != "exact":
                return row | {"t_s_ms": row["t_s_ms"] * 9.45}  # 850 ms are just below 90 sweeps
            return row | {"factor_mflop_done": 3740 if row["threads"] == 1 else 3750}
        told = self.told([changed(row) for row in stored_data.large_scenes_rows()])
        self.assertIn("| 89.9 | 0.20 | at most 90 sweeps: holds |", told)
        self.assertIn("| 37.4 | 50.0 | 75 % | does not hold |\n", told)
        self.assertIn("| 75.0 | 100 | 75 % | holds |", told)

    def test_a_pile_that_was_slow_beside_a_slow_one_is_not_slower(self):
        rows = stored_data.large_scenes_rows()
        ratios = [line[7] for line in large_scenes.pile_lines([row for row in rows if row["round"] == 3])]
        self.assertEqual(ratios, ["1.00", "1.00", "1.70", "1.50"])

    def test_rows_that_waited_for_a_core_do_not_count_and_are_counted(self):
        """The first round of 10000 rocks on two threads, where it had been fast, and all of the silo on one."""
        def waited(row):
            return ((row["scene"], row["round"], row["threads"]) == ("rock_pile", 1, 2) and row["bodies"] == 10000 or
                    row["scene"] == "silo" and row["threads"] == 1)
        rows = [row | {"t_s_waiting_ms": 0.051 * row["t_s_ms"] * int(row["threads"]), "t_s_ms": row["t_s_ms"] / 100}
                if waited(row) else row for row in stored_data.large_scenes_rows()]
        told = self.told(rows)
        self.assertIn("are left out: 4.", told)
        self.assertIn("| 10000 | 2 | 100000 | 5 | 0.0200 | 2750 | 5.50 | 1.00 |", told)
        self.assertIn("| 15000 | 1.50 | 1.50 | - | 2.00 | at most 1.6 times the smallest: holds |", told)
        self.assertIn("| 10000 | 1 | 300000 | 4 | - | 1.10 | 1.10 | - | - | - | not measured |\n", told)

    def test_a_sweep_that_waited_and_files_without_sweeps_tell_none(self):
        rows = stored_data.large_scenes_rows()
        slow = [row | {"t_s_waiting_ms": 0.11 * row["t_s_ms"]} if row["solver"] != "exact" and row["round"] < 3 else row
                for row in rows]
        self.assertIn("| 850 | 0.20 | at most 90 sweeps: does not hold |", self.told(slow))  # by the third round
        older = [{name: value for name, value in row.items() if name != "solver"} for row in rows if row["solver"] == "exact"]
        self.assertIn("| 10000 | 1 | 100000 | 5 | 0.0200 | 850 | 1.70 | 1.00 | - | 0.20 | at most 90 sweeps: not measured |\n",
                      self.told(older))


STAND_IN = NOTES_ITS_CALL + f"""import h5py, numpy
from synthetic import write_steps
out = pathlib.Path(given["--out"])
if words[0] == "record":
    out.mkdir(parents=True)
    count = int(given["--bodies"])
    with h5py.File(out / f"{{given['--scene']}}_step{{int(given['--at']):06}}.h5", "w") as file:
        file["mass"] = numpy.zeros((count, 6, 6))
        file["row_body"] = numpy.array([(0, 1), (1, 0), (0, -1)], dtype=numpy.int32)
    sys.exit(2)  # as steps that sweeps move are not exact
else:
    scene, bodies = pathlib.Path(words[1]).parent.name.rsplit("_", 1)
    status = "ok" if given["--solver"] == "exact" else "not_converged"
    write_steps(out, [dict(scene=scene, bodies=bodies, step=40, solver=given["--solver"], threads=given["--threads"], rows=1000,
                           factorizations=2, kinetic_energy_j=1, t_s_ms=int(bodies), t_s_waiting_ms=0,
                           t_s_factor_local_ms=2, factor_mflop_local=0.01, factor_mflop_done=60, peak_memory_mb=100,
                           partitioner="-", refiner="-", status=os.environ.get("STAND_IN_STATUS", status))])
"""
BENCHMARK = f"""#!/usr/bin/python3
import json, os, sys
sys.path.insert(0, {str(ROOT / "tests" / "scripts")!r})
""" + """import stand_in_key
context = {name: value for name, value in stand_in_key.key(sys.argv).items() if name.startswith("git_")}
context |= json.loads(os.environ.get("STAND_IN_CONTEXT", "{}"))
with open(os.environ["STAND_IN_LOG"], "a") as log:
    log.write("benchmark " + " ".join(sys.argv[1:]) + "\\n")
given = dict(word.split("=", 1) for word in sys.argv[1:])
json.dump({"context": context, "benchmarks": [{"name": f"{name}/3000/manual_time", "run_type": "iteration", "gflop_per_s": rate}
                          for name, rate in (("cholesky:AVX2", 30), ("cholesky:AVX-512", 40), ("cholesky_2", 60))]},
          open(given["--benchmark_out"], "w"))
"""


class LargeScenesTest(StandInCase):
    stand_in = STAND_IN
    script = "large_scenes"

    def setUp(self):
        super().setUp()
        beside = self.directory / "tests" / "dense_benchmark"
        beside.parent.mkdir()
        beside.write_text(BENCHMARK)
        beside.chmod(0o755)

    def test_every_round_times_a_dense_factorisation_and_replays_every_scene_alone(self):
        said = self.run_it("--piles", "10,20", "--silos", 2, "--rounds", 2).stdout
        calls = self.calls()
        self.assertEqual([call.partition(" --out")[0] for call in calls[:3]],
                         [f"record --scene {scene} --at {step} --bodies {bodies} --advance pgs@sweeps=30"
                          for scene, step, bodies in (("rock_pile", 300, 10), ("rock_pile", 300, 20), ("silo", 40, 2))])
        self.assertEqual([call.split()[0] for call in calls[3:]], ["benchmark", *["replay"] * 8] * 2)
        replayed = [(words[1].split("/")[-2], words[words.index("--solver"):words.index("--out")])
                    for words in map(str.split, calls[3:]) if words[0] == "replay"]
        exact, sweeps = ([f"--solver exact --repeats 3 --threads {threads}" for threads in (1, 2)],
                         "--solver pgs@sweeps=300 --repeats 1 --threads 1")
        ten, twenty, silo = ([(name, options.split()) for options in (*exact, *more)]
                             for name, *more in (("rock_pile_10", sweeps), ("rock_pile_20", sweeps), ("silo_2",)))
        self.assertEqual(replayed, ten + twenty + silo + silo + twenty + ten)
        with open(self.directory / "out" / "large_scenes.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual((tuple(rows[0]), len(rows)), (large_scenes.COLUMNS, 16))
        self.assertEqual([row["dissection_mflop"] for row in rows[:2]], ["nan", "nan"])
        self.assertIn("| 20 | 1 | 1000 | 2 | 0.0500 | 20.0 | 10.0 | 2.00 | 300 | 0.10 | "
                      "at most 1.6 times the smallest: does not hold |", said)
        pair = 1e-6 * sum(k**2 for k in range(1, 13))
        self.assertIn(f"| 2 | 1 | 1000 | 2 | 2.00 | 1.0e-5 | {0.01 / pair:.2f} | 30.0 | 40.0 | 75 % | holds |", said)
        self.assertIn("| 30.0 | 60.0 | 50 % | does not hold |", said)
        self.assertTrue(said.endswith("Solves that waited more than 5 % of t_s a thread for a core are left out: 0.\n"), said)

    def test_a_benchmark_of_another_build_is_refused(self):
        with unittest.mock.patch.dict(os.environ, STAND_IN_CONTEXT='{"git_hash": "ffffffffffff"}'):
            said = self.run_it("--piles", "10", "--silos", 2, "--rounds", 1, code=1).stderr.splitlines()[-1]
        self.assertIn("are builds of commits ffffffffff", said)

    def test_options_and_failures_are_one_line(self):
        self.check_refused((("--piles", "1"), "--piles has '1', expected a whole number from 2 to 200000"),
                           (("--silos", "4,x"), "--silos has 'x'"), (("--rounds", 0), "--rounds is '0'"))
        with unittest.mock.patch.dict(os.environ, STAND_IN_STATUS="not_converged"):
            self.assertIn("1 of 1 replayed cells are not ok",
                          self.run_it("--piles", 10, "--silos", 2, code=1).stderr.splitlines()[-1])
        self.assertFalse((self.directory / "out").exists())


if __name__ == "__main__":
    unittest.main()
