"""The regret of auto as scripts/partition_regret counts it."""
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
from cleave_scripts.measurements import regret  # noqa: E402


def rows_of(times, scene="pile", solver="schur", step=100, replay="one"):
    """times: {(partitioner, refiner): [(t_pr, t_s) a round, from round 1]}; of one step."""
    return [{"scene": scene, "solver": solver, "step": step, "partitioner": partitioner, "refiner": refiner,
             "round": number, "replay": replay,
             "t_pr_ms": str(t_pr), "t_s_ms": str(t_s), "auto_choice": "mix+fm/schur-rows" if partitioner == "auto" else "-"}
            for (partitioner, refiner), rounds in times.items() for number, (t_pr, t_s) in enumerate(rounds, 1)]


TIMES = {("mindp", "none"): [(0, 12), (0, 12)], ("mix", "fm"): [(1, 7), (1, 9)], ("bfs", "fm"): [(1, 9), (1, 1)],
         ("auto", "none"): [(1, 4), (2, 8.5)], ("auto", "fm"): [(0, 1), (0, 1)]}


class RegretTest(unittest.TestCase):
    def one(self, **changes):
        (found,) = regret.regrets(rows_of({**TIMES, **changes.get("times", {})}))
        return found

    def test_the_best_cell_is_chosen_by_the_odd_rounds_and_compared_by_the_even_ones(self):
        found = self.one()
        self.assertEqual((found.best, found.best_ms, found.baseline_ms, found.auto_ms), ("mix+fm", 10, 12, 10.5))
        self.assertAlmostEqual(found.regret, 0.05)
        self.assertTrue(found.holds)
        self.assertEqual(found.choices, ["mix+fm/schur-rows"])

    def test_more_than_a_tenth_does_not_hold_nor_does_what_mindp_does_better(self):
        self.assertFalse(self.one(times={("auto", "none"): [(0, 1), (0, 11.1)]}).holds)
        self.assertFalse(self.one(times={("mindp", "none"): [(0, 12), (0, 10.4)]}).holds)

    def test_steps_are_averaged_and_scenes_stand_apart(self):
        twice = rows_of(TIMES) + rows_of({cell: [(0, 0)] * 2 for cell in TIMES}, step=200) + rows_of(TIMES, "tower")
        pile, tower = regret.regrets(twice)
        self.assertEqual((pile.scene, pile.auto_ms), ("pile", 10.5 / 2))
        self.assertEqual((tower.scene, tower.auto_ms), ("tower", 10.5))

    def test_of_a_step_the_median_round_counts(self):
        rows = rows_of({**TIMES, ("auto", "none"): [(0, 0), (0, 10), (0, 0), (0, 99), (0, 0), (0, 11)]})
        self.assertEqual(regret.regrets(rows)[0].auto_ms, 11)

    def test_where_the_kernel_is_chosen_all_kernels_are_the_grid(self):
        others = {("mindp", "none"): [(0, 11), (0, 11)], ("mix", "fm"): [(0, 9), (0, 20)]}
        rows = (rows_of(TIMES, solver="pivot:a") + rows_of(others, solver="pivot:b") +
                rows_of({("-", "-"): [(float("nan"), 7.5)] * 2}, solver=regret.WHOLE) +
                rows_of({("auto", "none"): [(1, 9), (1, 7.3)]}, solver="pivot:chosen"))
        alone, chosen = regret.regrets(rows)
        self.assertEqual((alone.solver, alone.best, alone.best_ms, alone.baseline_ms), ("pivot:a", "mix+fm", 10, 12))
        self.assertEqual((chosen.solver, chosen.best, chosen.best_ms), ("pivot:chosen", "monolithic", 7.5))
        self.assertEqual((chosen.baseline_ms, chosen.auto_ms), (11, 8.3))
        self.assertFalse(chosen.holds)
        rows[-1]["t_s_ms"] = "7.2"
        self.assertTrue(regret.regrets(rows)[1].holds)

    def test_replays_of_all_kernels_are_put_at_one_pace(self):
        def whole(time_ms, replay):
            return rows_of({("-", "-"): [(float("nan"), time_ms)] * 2}, solver=regret.WHOLE, replay=replay)

        # The replay of auto is half as fast as the other throughout.
        rows = (rows_of({("mindp", "none"): [(0, 6), (0, 6)]}, solver="pivot:a", replay="a") + whole(4, "a") +
                rows_of({("auto", "none"): [(1, 7), (1, 7)]}, solver="pivot:chosen", replay="any") + whole(8, "any"))
        (chosen,) = regret.regrets(rows)
        self.assertEqual((chosen.best, chosen.best_ms, chosen.auto_ms, chosen.baseline_ms), ("monolithic", 6, 6, 9))


if __name__ == "__main__":
    unittest.main()
