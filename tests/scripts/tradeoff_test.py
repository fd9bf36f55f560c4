"""scripts/tradeoff: what is made of its rows, and the command with a stand-in for the program."""
import csv
import math
import unittest

from stand_in import NOTES_ITS_CALL, StandInCase

from cleave_scripts.figures import style, time_to_accuracy
from cleave_scripts.measurements import crossover, partitions_of_solvers
from cleave_scripts.measurements.accuracy import LIMITS, failures, method_of, problems, profile, sweep_costs
from cleave_scripts.measurements.motion_of_solvers import MOVERS, SCENES

STAND_IN = NOTES_ITS_CALL + f"""import h5py
import numpy
from synthetic import write_manifest, write_steps
out = pathlib.Path(given["--out"])
out.mkdir(parents=True, exist_ok=True)
if words[0] == "record":
    with h5py.File(out / f"{{given['--scene']}}_step{{int(given['--at']):06}}.h5", "w") as file:
        file.attrs["words"] = " ".join(words)
        file["mass"] = numpy.tile(numpy.eye(6), (3, 1, 1)) * numpy.array([1, 3, 2])[:, None, None]
    sys.exit(0)
same = dict(seed=1, bodies=given.get("--bodies", 200), rows=900, iterations=7, largest_free_velocity_m_per_s=2, t_pr_ms=0.5, interface_rows=9, residual_m_per_s=1e-12,
            status="ok", max_penetration_m=1e-3, joint_drift_m=0, kinetic_energy_j=1, potential_energy_j=2, t_s_ms=4, partitioner="-", refiner="-")
if words[0] == "run":
    every = int(given["--measure-every"])
    measured = range(every - 1, int(given["--steps"]), every)
    with h5py.File(out / "motion.h5", "w") as file:
        file["step"], file["mass"] = numpy.array(measured), numpy.ones(2)
        file["position"] = numpy.array([[[0, 0, 1], [0, 0, step + 0.5]] for step in measured])
    write_steps(out, [dict(same, scene=given["--scene"], step=step, time_s=step / 60, solver=solver, cfm=given.get("--cfm", 1e-5))
                      for step in measured for solver in given["--solver"].split(",")])
    sys.exit(2 if "pgs" in given["--solver"] else 0)
with h5py.File(words[1]) as file:
    asked = file.attrs["words"].split()
asked = dict(zip(asked, asked[1:]))
rows = []
for solver in given["--solver"].split(","):
    until = float(solver.partition("@until=")[2].partition("@")[0] or 0)
    rows.append(dict(same, scene=asked["--scene"], bodies=asked.get("--bodies", 200), cfm=asked["--cfm"], step=200, solver=solver,
                     residual_m_per_s=until or 1e-12, t_s_ms=0.1 / until if until else 4, status="not_converged" if until else "ok"))
write_steps(out, rows)
write_manifest(out)
sys.exit(2)
"""


def row(solver, t_s_ms, residual, partitioner="-", fastest=1.0, step=1):
    return {"series": "paper", "scene": "s", "bodies": "9", "mass_ratio": "1", "cfm": "1e-5", "step": str(step), "rows": "50", "solver": solver, "partitioner": partitioner,
            "refiner": "-" if partitioner == "-" else "fm", "t_pr_ms": "1", "t_s_ms": str(t_s_ms),
            "residual_m_per_s": str(residual), "largest_free_velocity_m_per_s": str(fastest)}


class AccuracyTest(unittest.TestCase):

    def test_a_method_is_a_solver_without_its_budget(self):
        self.assertEqual(method_of(row("pgs@until=0.1@order=random@sweeps=9", 1, 1)), "pgs@order=random")
        self.assertEqual(method_of(row("pgs-parts@until=0.1", 1, 1, "mix")), "pgs-parts, mix+fm")

    def test_the_fastest_solve_within_a_limit_counts_and_what_never_gets_there_takes_for_ever(self):
        problem, = problems([row("exact", 4, 1e-12), row("pgs@until=0.1", 1, 0.09), row("pgs@until=0.01", 0.5, 0.005),
                             row("pgs@until=0.001", 9, 0.002)])
        self.assertEqual([problem.time_ms("pgs", limit) for limit in LIMITS[:3]], [0.5, 0.5, math.inf])
        self.assertEqual({problem.time_ms("exact", limit) for limit in LIMITS}, {4})
        self.assertEqual(problem.iterative, ("pgs",))
        self.assertEqual(problem.crossover(), LIMITS[2])

    def test_a_residual_is_relative_to_the_free_velocity_and_partitions_are_paid_for(self):
        problem, = problems([row("schur", 4, 0.5, "mix", fastest=10)])
        self.assertEqual(problem.time_ms("schur, mix+fm", LIMITS[0]), 5)
        slow, = problems([row("pgs", 4, 0.05, fastest=0.1)])  # not divided by less than 1, which would make it 0.5
        self.assertEqual([slow.time_ms("pgs", limit) for limit in LIMITS[:2]], [4, math.inf])

    def test_a_sweep_costs_its_time_over_rows_and_sweeps_of_long_solves(self):
        long = {**row("pgs@until=0.1@sweeps=300", 2, 0.09), "iterations": "200"}
        short = {**row("pgs@until=0.1@sweeps=300", 9, 0.09), "iterations": "9"}
        direct = {**row("exact", 9, 0.09), "iterations": "200"}
        self.assertEqual(sweep_costs([long, short, direct]), {"pgs": [200]})

    def test_no_crossover_where_another_is_faster_at_the_last_limit(self):
        problem, = problems([row("exact", 4, 1e-12), row("schur", 1, 1e-12, "mix"), row("pgs@until=1e-08", 5, 1e-9)])
        self.assertEqual(problem.crossover(), LIMITS[0])  # direct solvers do not count
        problem, = problems([row("exact", 4, 1e-12), row("pgs@until=1e-08", 3, 1e-9)])
        self.assertIsNone(problem.crossover())

    def test_exact_is_faster_where_a_ratio_is_above_one(self):
        faster = crossover.exact_is_faster
        self.assertEqual(faster([(1, 2), (2, 3)]), [(None, None)])
        self.assertEqual(faster([(1, 0.5), (2, 0.9)]), [])
        (start, end), = faster([(1, 0.25), (100, 4), (1000, math.inf)])
        self.assertAlmostEqual(start, 10)
        self.assertIsNone(end)
        (start, end), (again, last) = faster([(1, 2), (4, 0.5), (8, math.inf)])
        self.assertEqual((start, end), (None, 2))
        self.assertAlmostEqual(again, math.sqrt(32))  # in the middle: infinite on one side
        self.assertIsNone(last)

    def test_axes_hold_the_piles_of_which_one_thing_changes(self):
        def pile(bodies, mass_ratio, cfm, rows, scene="rock_pile"):
            return {**row("exact", 1, 1e-12), "scene": scene, "bodies": str(bodies), "mass_ratio": str(mass_ratio), "cfm": cfm, "rows": str(rows)}

        found = problems([pile(200, 1, "1e-6", 9), pile(50, 1, "1e-6", 5), pile(200, 1, "1e-8", 8), pile(200, 100, "1e-6", 7),
                          pile(50, 1, "1e-8", 3), pile(200, 1, "1e-6", 2, "silo")])
        self.assertEqual([[axis.of(problem) for problem in axis.problems(found)] for axis in crossover.AXES],
                         [[5, 9], [1, 100], [1e-8, 1e-6]])
        figure = time_to_accuracy.draw_crossover(problems([pile(200, 1, "1e-6", 9), {**pile(200, 1, "1e-6", 9), "solver": "pgs@until=0.1"}]))
        self.assertEqual([len(ax.lines) for ax in figure.axes], [len(crossover.LIMITS) + 1] * 3)
        style.pyplot.close(figure)

    def test_quickstep_is_told_how_long_to_go_on(self):
        problem, = problems([row("exact", 4, 1e-12), row("ode-quickstep@quickstep-iterations=20", 1, 0.09)])
        self.assertEqual(problem.iterative, ("ode-quickstep",))
        self.assertEqual(problem.against_exact(0.1), 0.25)

    def test_profiles_are_ratios_to_the_fastest_with_failures_told(self):
        found = problems([row("exact", 4, 1e-12), row("pgs", 1, 1e-2), row("exact", 2, 1e-12, step=2), row("pgs", 8, 1, step=2)])
        self.assertEqual(profile(found, 1e-2), {"exact": [1, 4], "pgs": [1, math.inf]})
        self.assertEqual({method: failures(ratios) for method, ratios in profile(found, 1e-8).items()}, {"exact": 0, "pgs": 2})
        self.assertEqual(profile(problems([row("pgs", 1, 1)]), 1e-8), {})

    def test_the_pictures_hold_every_problem_and_name_failures(self):
        found = problems([row("exact", 4, 1e-12), row("pgs", 1, 1e-2), row("exact", 2, 1e-12, step=2), row("pgs", 8, 1, step=2)])
        figure = time_to_accuracy.draw_times(found)
        self.assertEqual(len(figure.axes), 2)
        style.pyplot.close(figure)
        figure = time_to_accuracy.draw_profiles(found)
        texts = [text.get_text() for text in figure.legends[0].get_texts()]
        style.pyplot.close(figure)
        self.assertEqual(texts, ["exact (never: 0/0/0/0)", "pgs (never: 1/2/2/2)"])


def split_row(solver, parts, t_s_ms, iterations=1, residual=1e-12, step=1):
    return {**row(solver, t_s_ms, residual, step=step), "partitioner": parts, "refiner": "fm", "t_pr_ms": "1", "iterations": str(iterations)}


class PartitionsOfSolversTest(unittest.TestCase):
    rows = [split_row("schur", "mix", 1), split_row("schur", "bfs", 3), split_row("schur", "mix", 1, step=2), split_row("schur", "bfs", 1, step=2),
            split_row("pgs-parts@until=0.0001", "mix", 3, 40), split_row("pgs-parts@until=0.0001", "bfs", 1, 10),
            split_row("pgs-parts@until=0.0001", "mix", 1, 10, step=2), split_row("pgs-parts@until=0.0001", "bfs", 1, 10, 1e-3, step=2)]

    def test_ratios_to_the_best_partition_are_averaged_over_problems(self):
        found = partitions_of_solvers.compare(self.rows)
        self.assertEqual(list(found), ["schur", "pgs-parts"])
        self.assertEqual(found["schur"]["mix", "fm"][0], 1)
        self.assertAlmostEqual(found["schur"]["bfs", "fm"][0], math.sqrt(2))
        self.assertTrue(math.isnan(found["schur"]["bfs", "fm"][1]))
        self.assertAlmostEqual(found["pgs-parts"]["mix", "fm"][0], math.sqrt(2))
        self.assertAlmostEqual(found["pgs-parts"]["mix", "fm"][1], 2)
        self.assertEqual(found["pgs-parts"]["bfs", "fm"][0], math.inf)  # one problem it never solved

    def test_ranks(self):
        def compared(one, other):
            return {"a": {key: (value, 0) for key, value in enumerate(one)}, "b": {key: (value, 0) for key, value in enumerate(other)}}

        self.assertAlmostEqual(partitions_of_solvers.ranks_agree(compared([1, 2, 3], [10, 20, math.inf]), "a", "b"), 1)
        self.assertAlmostEqual(partitions_of_solvers.ranks_agree(compared([1, 2, 3], [9, 8, 7]), "a", "b"), -1)
        self.assertAlmostEqual(partitions_of_solvers.ranks_agree(compared([1, 2, 3, 4], [1, 1, 2, 2]), "a", "b"), 2 / math.sqrt(5))


class TradeoffTest(StandInCase):
    stand_in = STAND_IN
    script = "tradeoff"

    def rows(self, name):
        with open(self.directory / "out" / name, newline="") as file:
            return list(csv.DictReader(file))

    def test_every_problem_meets_every_solver_and_limit(self):
        self.run_it("--steps", 20)
        solves = self.rows("tradeoff.csv")
        found = problems(solves)
        self.assertEqual(len([problem for problem in found if problem.is_drawn]), 18)
        self.assertEqual({problem.mass_ratio for problem in found}, {3})
        self.assertEqual({len(problem.times_ms) for problem in found}, {6 + 1 + 9})
        moved = self.rows("tradeoff_motion.csv")
        self.assertEqual({(line["scene"], line["mover"]) for line in moved},
                         {(scene, mover.name) for scene in SCENES for mover in MOVERS})
        self.assertEqual({line["height_m"] for line in moved if line["step"] == "5"}, {"5.5"})
        split = self.rows("tradeoff_partitions.csv")
        self.assertEqual({line["cfm"] for line in split}, {"1e-4"})
        self.assertEqual({partitions_of_solvers.solver_name(line) for line in split},
                         {*partitions_of_solvers.DIRECT, *partitions_of_solvers.ITERATIVE})
        runs = [call for call in self.calls() if call.startswith("run ") and "--advance" in call]
        self.assertEqual(len(runs), len(SCENES) * len(MOVERS))
        for words in map(str.split, runs):  # alone: what is measured is what moves the world
            self.assertEqual(words[words.index("--advance") + 1], words[words.index("--solver") + 1])
        small, = [call for call in runs if "--scene rock_pile" in call and " 1 --steps 400 " in call]
        self.assertIn(f"--dt {1 / 60 / 20!r}", small)
        for name in ("time_to_accuracy", "crossover", "accuracy_profile"):
            self.assertTrue((self.directory / "out" / f"{name}.png").exists(), name)

    def test_one_table_alone(self):
        self.run_it("--steps", 20, "--tables", "partitions")
        self.assertEqual([path.name for path in (self.directory / "out").iterdir()], ["tradeoff_partitions.csv"])
        self.assertTrue(all("--partitioner all" in call for call in self.calls() if call.startswith("replay")), self.calls())

    def test_options(self):
        self.assertIn("--most-sweeps is '0'", self.run_it("--most-sweeps", 0, code=1).stderr)


if __name__ == "__main__":
    unittest.main()
