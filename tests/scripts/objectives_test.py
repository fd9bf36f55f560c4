"""scripts/partition_objectives and scripts/elimination_orders: what is made of their rows, and the commands with stand-ins."""
import csv
import itertools
import pathlib
import tempfile
import unittest

import stored_data
from stand_in import NOTES_ITS_CALL, StandInCase
from synthetic import PROGRAM

from cleave_scripts.documents import large, modelled_cost
from cleave_scripts.documents.stored import Stored
from cleave_scripts.measurements import elimination_orders, objectives
from cleave_scripts.measurements.every_scene import MOVED_FAST

STAND_IN = NOTES_ITS_CALL + """import objectives_test
objectives_test.answer(words, given)
"""


def answer(words, given):
    """What is by modelled time cuts twice the rows, and takes half as long."""
    from synthetic import touch_recorded, write_steps
    if words[0] == "record":
        return touch_recorded(given)
    files = [pathlib.Path(word) for word in words if word.endswith(".h5")]
    names = itertools.product(given["--partitioner"].split(","), given["--refiner"].split(","))
    cells = [(*name, "cost" in "".join(name)) for name in names]
    write_steps(pathlib.Path(given["--out"]), [
        dict(scene=file.name[:-14], bodies=9, step=int(file.name[-9:-3]), solver=given["--solver"], partitioner=partitioner,
             refiner=refiner, max_bodies=25, parts=3, interface_rows=40 if by_cost else 20, threads=given["--threads"],
             status="ok", t_pr_ms=1 if by_cost else 0, t_s_ms=5 if by_cost else 10)
        for file in files for partitioner, refiner, by_cost in cells])


def rows_of(cell, times, rows=20, scene="pile", solver="pivot:schur-rows", step=1):
    """times: (t_pr, t_s) a round."""
    partitioner, refiner = cell.split("+")
    return [{"scene": scene, "solver": solver, "step": step, "partitioner": partitioner, "refiner": refiner, "round": number,
             "interface_rows": rows, "t_pr_ms": t_pr, "t_s_ms": t_s} for number, (t_pr, t_s) in enumerate(times, 1)]


class GainTest(unittest.TestCase):

    def all_pairs(self, cut, cost, **of_all):
        return [row for pair in objectives.PAIRS.items() for cell, (times, rows) in zip(pair, (cut, cost))
                for row in rows_of(cell, times, rows, **of_all)]

    def test_a_gain_is_of_sums_of_medians(self):
        rows = (self.all_pairs(([(1, 10), (1, 10), (1, 99)], 20), ([(2, 4), (2, 5), (2, 9)], 30)) +
                self.all_pairs(([(0, 20)] * 3, 30), ([(0, 10)] * 3, 45), step=2))
        (found,) = objectives.gains(rows).values()
        self.assertEqual(list(found), list(objectives.PAIRS))
        for gain in found.values():
            self.assertEqual(gain, objectives.Gain(75 / 50, 15 / 30, 17 / 31))

    def test_scenes_and_kernels_stand_apart(self):
        rows = (self.all_pairs(([(0, 4)], 1), ([(0, 2)], 1)) + self.all_pairs(([(0, 4)], 1), ([(0, 3)], 1), scene="tower") +
                self.all_pairs(([(0, 4)], 1), ([(0, 4)], 1), solver="pivot:schur-bodies"))
        self.assertEqual([gain.t_s for of_key in objectives.gains(rows).values() for gain in of_key.values()],
                         [0.5] * 6 + [0.75] * 6 + [1] * 6)

    def test_where_neither_cuts_nothing_is_gained_and_where_one_alone_does_no_number_tells_it(self):
        for cost_rows, ratio in ((0, 1), (3, float("inf"))):
            rows = self.all_pairs(([(0, 4)], 0), ([(0, 4)], cost_rows))
            self.assertEqual({gain.rows for of_key in objectives.gains(rows).values() for gain in of_key.values()}, {ratio})


class ObjectivesTest(StandInCase):
    script, stand_in = "partition_objectives", STAND_IN

    def test_every_kernel_is_modelled_by_itself_and_pairs_alone_are_kept(self):
        self.run_it("--rounds", 2, "--threads", 2)
        replays = [call.split() for call in self.calls() if call.startswith("replay ")]
        self.assertEqual(len(replays), 7 * 2 * 3 * 2)
        for words in replays:
            given = dict(zip(words, words[1:]))
            self.assertEqual(given["--solver"], f"pivot:{given['--cost-kernel']}")
            self.assertEqual((given["--threads"], given["--cost-threads"]), ("2", "2"))
        with open(self.directory / "out" / "partition_objectives.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 7 * 6 * 2 * 3 * 2 * len(objectives.PAIRS))
        stored_data.write_provenance(self.directory / "out", "partition_objectives.csv")
        made = modelled_cost.objectives_of_parts(Stored(self.directory / "out"))
        self.assertIn("sums over 6 recorded steps of a scene, medians of 2 rounds", made)
        self.assertIn("| mixed site, pivot:schur-nested |" + 6 * " 2.00 / 0.50 / 0.60 |", made)

    def test_bad_input_is_one_line(self):
        self.check_refused((("--rounds", 0), "--rounds is '0', expected a whole number from 1"),
                           (("--threads", "x"), "--threads is 'x', expected a whole number from 1"))


class EliminationOrdersTest(unittest.TestCase):

    def count(self, *scene):
        with tempfile.TemporaryDirectory() as scratch:
            return elimination_orders.count(PROGRAM, scratch, *scene)

    def test_every_order_is_counted_and_the_least_of_two_is_taken(self):
        """A silo that is large enough for dissection, and a pile that is not."""
        for scene in (("silo", 2, ("--bodies", "2000", *MOVED_FAST)), ("rock_pile", 40, ("--bodies", "30"))):
            rows = self.count(*scene)
            self.assertEqual([row["order"] for row in rows], list(elimination_orders.ORDERS))
            counts = {row["order"]: float(row["factor_mflop"]) for row in rows}
            self.assertTrue(all(count > 0 for count in counts.values()), counts)
            self.assertLessEqual(counts["exact"], counts["minimum degree"])
            self.assertEqual(counts["exact"] < counts["minimum degree"], scene[0] == "silo")

    def test_the_table_has_a_line_a_step(self):
        rows = [{"scene": "silo", "bodies": 9, "step": step, "rows": 30, "order": order, "factor_mflop": step + place}
                for step in (1, 2) for place, order in enumerate(elimination_orders.ORDERS)]
        with tempfile.TemporaryDirectory() as directory:
            root = pathlib.Path(directory)
            stored_data.write_csv(root / "elimination_orders.csv", rows)
            stored_data.write_provenance(root, "elimination_orders.csv")
            made = large.elimination_orders(Stored(root))
        self.assertIn("| silo, 9 bodies, step 2 | 30 | 2.00 | 3.00 | 4.00 | 5.00 | 6.00 | 7.00 | 8.00 |", made)


class OrdersCommandTest(StandInCase):
    script = "elimination_orders"
    stand_in = NOTES_ITS_CALL + "sys.exit(1)\n"

    def test_a_run_that_fails_is_one_line(self):
        said = self.run_it(code=1).stderr.splitlines()
        self.assertIn("record stopped with exit code 1", said[-1])
        self.assertFalse((self.directory / "out").exists())


if __name__ == "__main__":
    unittest.main()
