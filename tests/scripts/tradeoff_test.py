"""scripts/tradeoff: what is made of its rows, and the command with a stand-in for the program."""
import csv
import math
import pathlib
import tempfile
import unittest

import stored_data
from stand_in import NOTES_ITS_CALL, StandInCase

from cleave_scripts.documents import accuracy
from cleave_scripts.documents.stored import NoResults, Stored
from cleave_scripts.figures import motion_of_solvers as motion_figure, price_of_accuracy, style, time_to_accuracy
from cleave_scripts.figures.tree import NoData
from cleave_scripts.measurements import crossover, partitions_of_solvers
from cleave_scripts.measurements.accuracy import (COLUMNS, LIMITS, failures, method_of, of_whole_steps, problems, profile,
                                                  refusals, settled_piles, sweep_costs, threads_in_words)
from cleave_scripts.measurements.motion_of_solvers import CASES, EXACT_AS_WELL, MOVERS, OF_FEW_ROWS, OF_SMALL, SMALL, motions

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
same = dict(seed=1, bodies=given.get("--bodies", 200), rows=900, iterations=7, largest_free_velocity_m_per_s=2, t_pr_ms=0.5,
            interface_rows=9, residual_m_per_s=1e-12, status="ok",
            threads=given.get("--threads", 1), max_penetration_m=1e-3, joint_drift_m=0, kinetic_energy_j=1,
            potential_energy_j=2, t_s_ms=4, partitioner="-", refiner="-")
if words[0] == "run":
    every = int(given["--measure-every"])
    measured = range(every - 1, int(given["--steps"]), every)
    with h5py.File(out / "motion.h5", "w") as file:
        file["step"], file["mass"] = numpy.array(measured), numpy.ones(2)
        file["position"] = numpy.array([[[0, 0, 1], [0, 0, step + 0.5]] for step in measured])
    write_steps(out, [dict(same, scene=given["--scene"], step=step, time_s=step / 60, solver=solver,
                           cfm=given.get("--cfm", 1e-5))
                      for step in measured for solver in given["--solver"].split(",")])
    sys.exit(2 if "pgs" in given["--solver"] else 0)
with h5py.File(words[1]) as file:
    asked = file.attrs["words"].split()
asked = dict(zip(asked, asked[1:]))
rows = []
for solver in given["--solver"].split(","):
    until = float(solver.partition("@until=")[2].partition("@")[0] or 0)
    gives_up = until and until < (0.02 if solver.startswith("pgs-colored") else 0.002)
    rows.append(dict(same, scene=asked["--scene"], bodies=asked.get("--bodies", 200), cfm=asked["--cfm"], step=asked["--at"],
                     solver=solver,
                     iterations=3000 if gives_up else 7,
                     residual_m_per_s=1 if gives_up else until or 1e-12, t_s_ms=0.1 / until if until else 4,
                     status="not_converged" if until else "ok"))
write_steps(out, rows)
write_manifest(out)
sys.exit(2)
"""


def row(solver, t_s_ms, residual, partitioner="-", fastest=1.0, step=1):
    return {"series": "paper", "scene": "s", "bodies": "9", "mass_ratio": "1", "cfm": "1e-5", "step": str(step),
            "rows": "50", "solver": solver, "partitioner": partitioner,
            "refiner": "-" if partitioner == "-" else "fm", "t_pr_ms": "1", "t_s_ms": str(t_s_ms), "iterations": "200",
            "residual_m_per_s": str(residual), "largest_free_velocity_m_per_s": str(fastest), "status": "ok"}


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
            return {**row("exact", 1, 1e-12), "scene": scene, "bodies": str(bodies), "mass_ratio": str(mass_ratio), "cfm": cfm,
                    "rows": str(rows)}

        found = problems([pile(200, 1, "1e-6", 9), pile(50, 1, "1e-6", 5), pile(200, 1, "1e-8", 8), pile(200, 100, "1e-6", 7),
                          pile(50, 1, "1e-8", 3), pile(200, 1, "1e-6", 2, "silo")])
        self.assertEqual([[axis.of(problem) for problem in axis.problems(found)] for axis in crossover.AXES],
                         [[5, 9], [1, 100], [1e-8, 1e-6]])
        at_rest = problems([{**pile(200, 1, "1e-6", 9), "series": "settled"}])
        self.assertEqual([axis.problems(at_rest) for axis in crossover.AXES], [[], [], []])
        figure = time_to_accuracy.draw_crossover(problems([pile(200, 1, "1e-6", 9),
                                                           {**pile(200, 1, "1e-6", 9), "solver": "pgs@until=0.1"}]))
        self.assertEqual([len(ax.lines) for ax in figure.axes], [len(crossover.LIMITS) + 1] * 3)
        self.assertIn("$t_{pr} + t_s$ (above 1", figure.axes[0].get_ylabel())
        style.pyplot.close(figure)

    def test_quickstep_is_told_how_long_to_go_on(self):
        problem, = problems([row("exact", 4, 1e-12), row("ode-quickstep@quickstep-iterations=20", 1, 0.09)])
        self.assertEqual(problem.iterative, ("ode-quickstep",))
        self.assertEqual(problem.against_exact(0.1), 0.25)

    def test_profiles_are_ratios_to_the_fastest_with_failures_told(self):
        found = problems([row("exact", 4, 1e-12), row("pgs", 1, 1e-2), row("exact", 2, 1e-12, step=2),
                          row("pgs", 8, 1, step=2)])
        self.assertEqual(profile(found, 1e-2), {"exact": [1, 4], "pgs": [1, math.inf]})
        self.assertEqual({method: failures(found, method, 1e-8) for method in profile(found, 1e-8)}, {"exact": 0, "pgs": 2})
        self.assertEqual(profile(problems([row("pgs", 1, 1)]), 1e-8), {})

    def test_a_solver_that_refuses_a_step_has_not_failed_on_it(self):
        refused = {**row("ode-step@ode-step-max-rows=1200", "nan", "nan"), "status": "refused"}
        found = problems([row("exact", 4, 1e-12), refused, row("exact", 4, 1e-12, step=2),
                          row("ode-step@ode-step-max-rows=1200", 9, 1, step=2)])
        self.assertEqual([problem.refused for problem in found], [("ode-step",), ()])
        self.assertEqual((failures(found, "ode-step", 1e-8), refusals(found, "ode-step"), refusals(found, "exact")), (1, 1, 0))
        self.assertEqual(profile(found, 1e-8)["ode-step"], [math.inf, math.inf])
        figure = time_to_accuracy.draw_profiles(found)
        texts = [text.get_text() for text in figure.legends[0].get_texts()]
        style.pyplot.close(figure)
        self.assertEqual(texts, ["exact (never: 0/0/0/0)", "ode-step (never: 1/1/1/1; refused: 1)"])

    def test_a_step_is_whole_where_every_solver_has_come_to_its_least_limit_or_given_up(self):
        whole = [row("exact", 4, 1e-12), row("pgs@until=0.1", 1, 0.09), row("pgs@until=0.01", 1, 0.009),
                 row("apgd@until=0.1", 1, 0.2),
                 row("ode-quickstep@quickstep-iterations=20", 1, 1), row("ode-quickstep@quickstep-iterations=500", 1, 1)]
        other = [{**line, "step": "2"} for line in whole]
        self.assertEqual(of_whole_steps(whole + other), whole + other)
        for lost in range(len(other)):
            kept = other[:lost] + other[lost + 1:]
            self.assertEqual(of_whole_steps(whole + kept), whole + kept if lost == 1 else whole, lost)
        self.assertEqual(of_whole_steps([]), [])

    def test_threads_are_those_of_the_rows(self):
        problem, = problems([{**row("exact", 4, 1e-12), "threads": "2"}])
        self.assertEqual((problem.threads, problems([row("exact", 4, 1e-12)])[0].threads), (("2",), ()))
        self.assertEqual([threads_in_words(threads) for threads in (("1",), ("2",), ("1", "2"), ())],
                         ["one thread", "2 threads", "1 or 2 threads", "number of threads not recorded"])

    def test_settled_piles_stand_apart(self):
        settled = {**row("exact", 4, 1e-12), "series": "settled", "kinetic_energy_j": "0.5"}
        found = problems([{**settled, "rows": "90", "step": "2"}, settled, row("exact", 4, 1e-12)])
        self.assertEqual([(pile.rows, pile.kinetic_energy_j) for pile in settled_piles(found)], [(50, 0.5), (90, 0.5)])
        self.assertEqual(settled_piles(found)[0].title, "s, 9 bodies, 50 rows, cfm 1e-05, settled")

    def test_the_pictures_hold_every_problem_and_name_failures(self):
        found = problems([row("exact", 4, 1e-12), row("pgs", 1, 1e-2), row("exact", 2, 1e-12, step=2),
                          row("pgs", 8, 1, step=2)])
        figure = time_to_accuracy.draw_times(found)
        self.assertEqual(len(figure.axes), 2)
        style.pyplot.close(figure)
        figure = time_to_accuracy.draw_profiles(found)
        texts = [text.get_text() for text in figure.legends[0].get_texts()]
        style.pyplot.close(figure)
        self.assertEqual(texts, ["exact (never: 0/0/0/0)", "pgs (never: 1/2/2/2)"])


class PriceTest(unittest.TestCase):

    def problems(self):
        """Two of the panels, one of them settled too, which is not drawn."""
        def of(scene, bodies, cfm, series="paper"):
            key = {"scene": scene, "bodies": str(bodies), "cfm": cfm, "series": series}
            return [{**line, **key} for line in (row("exact", 4, 1e-12), row("schur", 4.1, 1e-12, "mix"),
                                                 {**row("lemke", "nan", "nan"), "status": "refused"},
                                                 row("newton:monolithic", 4, 1), row("pgs@until=0.1", 1, 0.09),
                                                 row("pgs@until=0.01@order=random", 2, 0.009))]

        return problems(of("crane", 124, "1e-10") + of("rock_pile", 200, "1e-4") + of("rock_pile", 200, "1e-4", "settled") +
                        of("silo", 200, "1e-4"))

    def test_every_solver_is_drawn_or_named(self):
        found = self.problems()
        self.assertEqual([problem.scene for problem in price_of_accuracy.shown(found)], ["rock_pile", "crane"])
        figure = price_of_accuracy.draw_price(found)
        self.assertEqual([text.get_text() for text in figure.legends[0].get_texts()], ["pgs", "pgs@order=random"])
        first, _ = figure.axes
        self.assertEqual(first.get_title(loc="left"), "Rock Pile, cfm 1e-4\n200 bodies, 50 rows")
        names = {text.get_text(): text.get_position()[1] for text in first.texts}
        self.assertEqual(list(names), ["newton", "failed:", "lemke", "refused:", "exact", "schur"])
        heights = list(names.values())
        for below, above in zip(heights, heights[1:]):
            self.assertGreaterEqual(above - below, price_of_accuracy.NAME_HEIGHT - 1e-12)
        style.pyplot.close(figure)
        with self.assertRaises(NoData):
            price_of_accuracy.draw_price(problems([row("exact", 4, 1e-12)]))

    def test_names_are_moved_no_more_than_they_need_to_be(self):
        self.assertEqual(price_of_accuracy.apart([0, 1, 2], 0.5), [0, 1, 2])
        for height, wanted in zip(price_of_accuracy.apart([0, 1, 1, 3], 1), (-1 / 3, 2 / 3, 5 / 3, 3), strict=True):
            self.assertAlmostEqual(height, wanted)
        self.assertEqual(price_of_accuracy.apart([], 1), [])


def split_row(solver, parts, t_s_ms, iterations=1, residual=1e-12, step=1, threads=None):
    told = {} if threads is None else {"threads": str(threads)}
    return {**row(solver, t_s_ms, residual, step=step), "partitioner": parts, "refiner": "fm", "t_pr_ms": "1",
            "iterations": str(iterations), **told}


class PartitionsOfSolversTest(unittest.TestCase):
    rows = [split_row("schur", "mix", 1), split_row("schur", "bfs", 3), split_row("schur", "mix", 1, step=2),
            split_row("schur", "bfs", 1, step=2), split_row("pgs-parts@until=0.0001", "mix", 3, 40),
            split_row("pgs-parts@until=0.0001", "bfs", 1, 10), split_row("pgs-parts@until=0.0001", "mix", 1, 10, step=2),
            split_row("pgs-parts@until=0.0001", "bfs", 1, 10, 1e-3, step=2)]

    def test_ratios_to_the_best_partition_are_averaged_over_problems(self):
        found = partitions_of_solvers.compare(self.rows)
        self.assertEqual(list(found), [("schur", ""), ("pgs-parts", "")])
        direct, iterative = found.values()
        self.assertEqual(direct["mix", "fm"][0], 1)
        self.assertAlmostEqual(direct["bfs", "fm"][0], math.sqrt(2))
        self.assertTrue(math.isnan(direct["bfs", "fm"][1]))
        self.assertAlmostEqual(iterative["mix", "fm"][0], math.sqrt(2))
        self.assertAlmostEqual(iterative["mix", "fm"][1], 2)
        self.assertEqual(iterative["bfs", "fm"][0], math.inf)  # one problem it never solved
        self.assertEqual([partitions_of_solvers.best_parts(of) for of in found.values()], [("mix", "fm")] * 2)

    def test_ranks(self):
        def compared(one, other):
            return {"a": {key: (value, 0) for key, value in enumerate(one)},
                    "b": {key: (value, 0) for key, value in enumerate(other)}}

        self.assertAlmostEqual(partitions_of_solvers.ranks_agree(compared([1, 2, 3], [10, 20, math.inf]), "a", "b"), 1)
        self.assertAlmostEqual(partitions_of_solvers.ranks_agree(compared([1, 2, 3], [9, 8, 7]), "a", "b"), -1)
        self.assertAlmostEqual(partitions_of_solvers.ranks_agree(compared([1, 2, 3, 4], [1, 1, 2, 2]), "a", "b"),
                               2 / math.sqrt(5))

    def on_two_threads(self):
        """One part takes 8 ms on one thread, mix 10; on two mix takes 4 and 6, one part 8."""
        until = "pgs-parts@until=0.0001"
        rows = [split_row("schur", "mix", 1, threads=1), {**split_row("schur", "single", 2, threads=1), "refiner": "none"}]
        for step in (1, 2):
            rows += [split_row(until, "mix", 9, 10, step=step, threads=1),
                     split_row(until, "mix", 2 * step + 1, 10, step=step, threads=2)]
            rows += [{**split_row(until, "single", 7, 10, step=step, threads=threads), "refiner": "none"} for threads in (1, 2)]
        return rows

    def test_parts_on_two_threads_are_held_against_one_part_and_against_the_same_on_one(self):
        rows = self.on_two_threads()
        compared = partitions_of_solvers.compare(rows)
        self.assertEqual(list(compared), [("schur", "1"), ("pgs-parts", "1"), ("pgs-parts", "2")])
        (parts, over_single, over_same), = partitions_of_solvers.in_parallel(rows, compared).values()
        self.assertEqual(parts, ("mix", "fm"))
        self.assertAlmostEqual(over_single, math.sqrt(24) / 8)
        self.assertAlmostEqual(over_same, math.sqrt(24) / 10)
        self.assertEqual(partitions_of_solvers.in_parallel(self.rows, partitions_of_solvers.compare(self.rows)), {})


def moved_row(scene, mover, step, bodies=None, t_s_ms=1, height_m=2.0, drift_m=0.0, potential_j=3.0):
    told = {} if bodies is None else {"bodies": str(bodies)}
    return {"scene": scene, "mover": mover, "step": str(step), "time_s": "1", "rows": "9", "iterations": "1",
            "residual_m_per_s": "1e-3", "max_penetration_m": "0.002", "joint_drift_m": str(drift_m), "height_m": str(height_m),
            "kinetic_energy_j": "5", "potential_energy_j": str(potential_j), "t_s_ms": str(t_s_ms), "status": "ok", **told}


class MotionTest(unittest.TestCase):
    small_rows = [moved_row(SMALL[0], mover, step, SMALL[1], height_m=2 + 0.003 * (mover == "lemke"))
                  for mover in ("exact", "lemke", "ode-quickstep, 20 substeps of 1") for step in (1, 2)]

    def test_a_motion_is_a_scene_of_a_size_and_a_mover(self):
        found = motions([moved_row("chain_drop", "pgs, 20 sweeps", 1, 100, t_s_ms=1),
                         moved_row("chain_drop", "pgs, 20 sweeps", 2, 100, t_s_ms=4),
                         *self.small_rows, moved_row("rock_pile", "exact", 1)])
        self.assertEqual([(of.title, of.family) for of in found],
                         [("chain drop, 100 bodies", "pgs"), ("rock pile, 25 bodies", "exact"),
                          ("rock pile, 25 bodies", "lemke"),
                          ("rock pile, 25 bodies", "ode-quickstep, small steps"), ("rock pile", "exact")])
        self.assertEqual([(of.mean_ms, of.step_ms) for of in found], [(2.5, 2.5), (1, 1), (1, 1), (1, 20), (1, 1)])
        self.assertEqual(found[0].mean_later("t_s_ms"), 4)

    def test_what_refuses_many_rows_moves_a_small_scene_and_what_is_exact_as_well(self):
        *of_all, (scene, options, movers) = CASES
        self.assertEqual({movers for _, _, movers in of_all}, {MOVERS})
        self.assertEqual(((scene, options[1]), movers), (SMALL, (*MOVERS, *EXACT_AS_WELL, *OF_FEW_ROWS)))
        words = OF_SMALL[len(MOVERS) + 1].arguments(500)
        self.assertEqual((words[1], words[3], words[5]), ("mix", "fm", "schur"))

    def test_the_picture_has_two_panels_a_scene_and_a_line_a_family(self):
        found = motions([*(moved_row("chain_drop", mover, 1, 100, drift_m=0.001, potential_j=potential) for mover, potential in
                           (("exact", 3.0), ("pgs, 20 sweeps", 6.0), ("pgs, 100 sweeps", 4.5))), *self.small_rows])
        figure = motion_figure.draw_motions(found)
        self.assertEqual([ax.get_ylabel() for ax in figure.axes],
                         ["joint drift, mm", "height over exact's", "penetration, mm", "height over exact's"])
        pgs, = [line for line in figure.axes[1].lines if len(line.get_ydata()) == 2]
        self.assertEqual(sorted(pgs.get_ydata()), [1.5, 2])
        self.assertEqual([text.get_text() for text in figure.legends[0].get_texts()],
                         ["exact", "pgs", "lemke", "ode-quickstep, small steps"])
        style.pyplot.close(figure)


class BlocksTest(unittest.TestCase):
    """What the documents say of made-up rows."""

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.root = pathlib.Path(scratch.name)

    def made(self, block, name, rows):
        stored_data.write_csv(self.root / name, rows)
        return block(Stored(self.root))

    def settled(self, rows, ode_step_ms, status="ok", series="settled"):
        told = {"series": series, "rows": str(rows), "step": str(rows), "threads": "1", "kinetic_energy_j": "0.25"}
        return [{**line, **told} for line in (row("exact", 2, 1e-12),
                                              {**row("ode-step@ode-step-max-rows=1200", ode_step_ms, 1e-12), "status": status})]

    def test_ode_step_is_held_against_exact_on_settled_piles_and_judged_at_500_rows(self):
        made = self.made(accuracy.ode_step, "tradeoff.csv", [*self.settled(915, 60), *self.settled(310, 8),
                                                             *self.settled(490, 31), *self.settled(2000, "nan", "refused")])
        self.assertIn("Settled rock piles, one thread: ", made)
        self.assertIn("| s, 9 bodies, 310 rows, cfm 1e-05, settled | 0.250 | 2.00 | 8.00 | 4.00 | - |\n"
                      "| s, 9 bodies, 490 rows, cfm 1e-05, settled | 0.250 | 2.00 | 31.0 | 15.5 | holds |\n"
                      "| s, 9 bodies, 915 rows, cfm 1e-05, settled | 0.250 | 2.00 | 60.0 | 30.0 | - |\n"
                      "| s, 9 bodies, 2000 rows, cfm 1e-05, settled | 0.250 | 2.00 | refused | - | - |", made)
        made = self.made(accuracy.ode_step, "tradeoff.csv", self.settled(500, 29))
        self.assertIn("| 29.0 | 14.5 | does not hold |", made)

    def test_a_table_without_settled_piles_says_so(self):
        with self.assertRaisesRegex(NoResults, "`results/tradeoff.csv` has no settled piles: `scripts/tradeoff` makes it anew"):
            self.made(accuracy.ode_step, "tradeoff.csv", self.settled(500, 29, series="paper"))

    def test_where_exact_is_ten_times_as_fast_is_told_with_the_ratio(self):
        until = "pgs@until=1e-06@sweeps=3000"
        made = self.made(accuracy.time_to_accuracy, "tradeoff.csv", [
            row("exact", 2, 1e-12), row(until, 20, 1e-7), row("exact", 2, 1e-12, step=2), row(until, 19, 1e-7, step=2),
            {**row("exact", 2, 1e-12, step=3), "mass_ratio": "100"}, {**row(until, 20, 1, step=3), "mass_ratio": "100"}])
        self.assertIn("`exact`, ms, number of threads not recorded, on recorded steps; then t_pr + t_s of the fastest", made)
        self.assertIn("\n\n`exact` is at least 10 times as fast as the fastest solver that iterates to 1e-6 on 2 of these 3 "
                      "steps: s, 9 bodies (cfm 1e-05: 10.0; mass ratio 100, cfm 1e-05: never). "
                      "Not on 1: s, 9 bodies (cfm 1e-05: 9.50).", made)

    def test_a_sweep_is_held_against_what_was_asked_of_its_solver(self):
        rows = [{**row(f"{solver}@until=0.1", cost * 50 * 200 / 1e6, 0.09, parts), "threads": "2"}
                for solver, parts, cost in (("pgs", "-", 21), ("pgs@order=height", "-", 24), ("pgs-parts", "mix", 26),
                                            ("apgd", "-", 15))]
        made = self.made(accuracy.sweep_cost, "tradeoff.csv", rows)
        self.assertIn("2 threads, of the solves", made)
        self.assertIn("| `pgs` | 1 | 21.0 | 21.0 | 21.0 | 20 | does not hold |\n"
                      "| `pgs@order=height` | 1 | 24.0 | 24.0 | 24.0 | 25 | holds |", made)
        self.assertIn("\n\nKept by all but `pgs` and `pgs-parts`.", made)

    def test_the_motions_say_why_some_solvers_move_one_scene_alone(self):
        made = self.made(accuracy.motion, "tradeoff_motion.csv", MotionTest.small_rows)
        self.assertIn("| rock pile, 25 bodies | lemke | 1.00 |", made)
        self.assertIn("`lemke` and `ode-step` refuse steps of as many rows as the other scenes have, "
                      "and `interior-point:monolithic` and `schur, mix+fm` solve to the same residual as `exact`: "
                      "these move rock pile, 25 bodies, alone. There the height at the end differs from that under `exact` "
                      "by at most 3.00 mm.", made)
        made = self.made(accuracy.motion, "tradeoff_motion.csv", [moved_row("rock_pile", "exact", 1)])
        self.assertTrue(made.endswith("| rock pile | exact | 1.00 | 0.00100 | 2.00 | 0 | 2.00 | 0.00500 | 0.00300 |"), made)

    def test_partitions_are_told_for_every_number_of_threads_with_the_best(self):
        made = self.made(accuracy.iterative_partitions, "tradeoff_partitions.csv",
                         [{**line, "interface_rows": "9"} for line in PartitionsOfSolversTest().on_two_threads()])
        self.assertIn("one thread where no other number is told; in brackets", made)
        self.assertIn("|  | `schur` | `pgs-parts` | `pgs-parts`, 2 threads |", made)
        self.assertIn("Best is for `schur` `mix+fm` (1.00; one part 1.50), "
                      "for `pgs-parts` `single+none` (1.00; one part 1.00), "
                      "for `pgs-parts`, 2 threads `mix+fm` (1.00; one part 1.63). "
                      "What is best for `schur` costs `pgs-parts` 1.25, `pgs-parts`, 2 threads 1.00 times the least. "
                      "`pgs-parts` with `mix+fm` takes on two threads 0.612 of the time of one part on one, "
                      "and 0.490 of that of the same parts on one.", made)
        made = self.made(accuracy.iterative_partitions, "tradeoff_partitions.csv",
                         [{**line, "interface_rows": "9"} for line in PartitionsOfSolversTest.rows])
        self.assertIn("number of threads not recorded; in brackets", made)
        self.assertIn("What is best for `schur` costs `pgs-parts` 1.41 times the least.\n\nRank", made)


class TradeoffTest(StandInCase):
    stand_in = STAND_IN
    script = "tradeoff"

    def rows(self, name):
        with open(self.directory / "out" / name, newline="") as file:
            return list(csv.DictReader(file))

    def test_every_problem_meets_every_solver_and_limit(self):
        self.run_it("--steps", 20)
        solves = self.rows("tradeoff.csv")
        self.assertEqual(tuple(solves[0]), COLUMNS)
        found = problems(solves)
        self.assertEqual(len([problem for problem in found if problem.is_drawn]), 18 + 2 + 4)
        self.assertEqual({problem.mass_ratio for problem in found}, {3})
        self.assertEqual({len(problem.times_ms) for problem in found}, {6 + 1 + 9})
        self.assertEqual({problem.threads for problem in found}, {("1",)})
        self.assertEqual([(pile.bodies, pile.key[-1]) for pile in settled_piles(found)],
                         [(26, "400"), (40, "400"), (74, "400"), (200, "400")])
        self.assertEqual(of_whole_steps(solves), solves)
        first = [line for line in solves
                 if all(line[name] == value
                        for name, value in zip(("series", "scene", "cfm"), ("paper", "chain_drop", "1e-4")))]
        for solver, limits in (("pgs-colored", ("0.1", "0.01")),
                               ("pgs@order=height", ("0.1", "0.01", "0.001"))):  # at the last of which it gives up
            self.assertEqual([line["solver"] for line in first if line["solver"].startswith(solver)],
                             [f"{solver}@until={limit}@sweeps=3000" for limit in limits])
        moved = self.rows("tradeoff_motion.csv")
        wanted = [(scene, mover) for scene, _, movers in CASES for mover in movers]
        self.assertEqual({(line["scene"], line["bodies"], line["mover"]) for line in moved},
                         {(scene, str(options[1]) if options else "200", mover.name) for scene, options, movers in CASES
                          for mover in movers})
        self.assertEqual({line["height_m"] for line in moved if line["step"] == "5"}, {"5.5"})
        split = self.rows("tradeoff_partitions.csv")
        self.assertEqual({line["cfm"] for line in split}, {"1e-4"})
        self.assertEqual({(partitions_of_solvers.solver_name(line), line["threads"]) for line in split},
                         {*((solver, "1") for solver in (*partitions_of_solvers.DIRECT, *partitions_of_solvers.ITERATIVE)),
                          *((solver, "2") for solver in partitions_of_solvers.ITERATIVE)})
        calls = [call.split() for call in self.calls() if call.startswith("run ")]
        runs = [words for words in calls if "--advance" in words]
        self.assertEqual(len(runs), len(wanted))
        for words in runs:  # alone: what is measured is what moves the world
            self.assertEqual(words[words.index("--advance") + 1], words[words.index("--solver") + 1])
        small, = [words for words in runs
                  if "rock_pile" in words and "--bodies" not in words and "1 --steps 400 " in " ".join(words)]
        self.assertIn(f"--dt {1 / 60 / 20!r}", " ".join(small))
        for words in calls:
            if "--advance" not in words:
                self.assertTrue(words[words.index("--solver") + 1].startswith("ode-step@ode-step-max-rows=1200,ode-quickstep@"),
                                words)
                self.assertIn("--threads 1 --repeats 3", " ".join(words))
        self.assertEqual({words[words.index("--steps") + 1] for words in calls if "--advance" not in words}, {"201", "401"})
        for name in ("price_of_accuracy", "time_to_accuracy", "crossover", "accuracy_profile", "tradeoff_motion"):
            self.assertTrue((self.directory / "out" / f"{name}.png").exists(), name)

    def test_solves_on_two_threads_say_so(self):
        self.run_it("--tables", "partitions", "--threads", 2)
        self.assertEqual({line["threads"] for line in self.rows("tradeoff_partitions.csv")}, {"2"})
        self.assertEqual(len([call for call in self.calls() if call.startswith("replay")]), 5)  # not again those that iterate

    def test_one_table_alone(self):
        self.run_it("--steps", 20, "--tables", "partitions")
        self.assertEqual([path.name for path in (self.directory / "out").iterdir()], ["tradeoff_partitions.csv"])
        self.assertTrue(all("--partitioner all" in call for call in self.calls() if call.startswith("replay")), self.calls())

    def test_options(self):
        self.assertIn("--most-sweeps is '0'", self.run_it("--most-sweeps", 0, code=1).stderr)


if __name__ == "__main__":
    unittest.main()
