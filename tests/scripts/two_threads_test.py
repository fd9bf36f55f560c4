"""scripts/two_threads with a stand-in for the program, and the shares that its rows become."""
import os
import pathlib
import unittest
import unittest.mock

import stored_data
from measurements_test import Measurement

from cleave_scripts.documents import speed
from cleave_scripts.measurements import thread_times
from cleave_scripts.results.errors import ResultError


class TwoThreadsTest(Measurement):
    script = "two_threads"

    def measure(self, *arguments, code=0, **settings):
        with unittest.mock.patch.dict(os.environ, {name: str(value) for name, value in settings.items()}):
            return self.run_it("--rounds", 3, *arguments, code=code)

    def test_three_ways_take_turns_on_the_same_files(self):
        told = self.measure("--bodies", 200).stderr
        self.assertRegex(told, r"round 2/3 done, 0 min \d+ s, about \d+ s to go\n")
        replays = [call.split() for call in self.calls() if call.startswith("replay")]
        for words in replays:  # which takes none twice
            files = [word for word in words if word.endswith(".h5")]
            self.assertEqual(len(set(files)), len(files))
        of_piles = [words for words in replays if "exact" in words[words.index("--solver") + 1]]
        turn = [("1", "replay0"), ("2", "replay0")]
        beside = {("1", "replay0"), ("1", "replay1")}
        for calls in (of_piles, [words for words in replays if words not in of_piles]):
            found = [(words[words.index("--threads") + 1], words[words.index("--out") + 1].rpartition("/")[2])
                     for words in calls]
            self.assertEqual([found[:2], set(found[2:4]), set(found[4:6]), found[6:8], found[8:10], set(found[10:])],
                             [turn, beside, beside, turn[::-1], turn, beside])
            self.assertEqual(len({" ".join(words[:words.index("--threads")]) for words in calls}), 1)

            files = [pathlib.Path(word) for word in calls[0] if word.endswith(".h5")]
            self.assertEqual({files[0].name, files[-1].name}, {files[1].name})
            self.assertEqual([files[0].parent.name, files[-1].parent.name], ["before", "after"])
        cells = 2 + 4 * 5  # compliances of a pile, steps of Large Rock Pile times partitioners
        self.assertEqual(len(self.rows("two_threads.csv")), cells * 3 * 3 * 3)  # solvers or refiners, ways, rounds

    def test_shares_of_the_chosen_piles_are_of_two_solves_side_by_side(self):
        said = self.measure("--bodies", "10000,200", STAND_IN_BESIDE=1.2).stdout
        records = [call.partition(" --out")[0] for call in self.calls() if call.startswith("record")]
        self.assertEqual(records, [
            f"record --scene rock_pile --at {step} --bodies {bodies} --cfm {cfm} --threads 2"
            for bodies, step in ((200, 200), (10000, 150)) for cfm in ("1e-5", "1e-10")
        ] + ["record --scene large_rock_pile --at 100,200,300,400 --threads 2"])
        self.assertEqual({row["bodies"] for row in self.rows("two_threads.csv")}, {"200", "600", "10000"})
        row = next(row for row in self.rows("two_threads.csv") if row["processes"] == "2" and row["bodies"] == "200")
        self.assertEqual((row["threads"], float(row["t_s_ms"]), row["t_s_waiting_ms"]), ("1", 8.8, "0.25"))
        self.assertIn("| 10000 | 1e-10 | pivot:schur-nested | 8.00 | 2.00 | 1.82 | 1.10 |", said)
        self.assertIn("| 300 | mindp+none | 8.00 | 2.00 | 1.82 | 1.10 | 15 of 15 |", said)
        self.assertIn("| 200 | 1e-05 | 1.10 (2.00 of 1.82) | 1.10 (", speed.two_threads(self.stored()))

    def test_a_low_ceiling_is_no_measurement(self):
        said = self.measure("--bodies", 600, STAND_IN_BESIDE=1.5).stdout
        self.assertIn("| 600 | 1e-05 | exact | 8.00 | 2.00 | 1.60 | not measured: ceiling below 1.7 |", said)
        self.assertIn("| 8.00 | 2.00 | 1.60 | not measured: ceiling below 1.7 | 0 of 15 |", said)
        self.assertIn("| 600 | 1e-05 | - (2.00 of 1.60) | - (", speed.two_threads(self.stored()))

    def test_replays_on_cores_far_apart_do_not_count(self):
        said = self.measure("--bodies", 600, STAND_IN_APART=300).stdout
        self.assertIn("| 600 | 1e-05 | exact | 8.00 | - | 2.00 | not measured: cores far apart |", said)
        self.assertIn("| 600 | 1e-05 | pivot:schur-nested | 8.00 | 2.00 | 2.00 | 1.00 |", said)
        self.assertTrue(said.endswith("\n6 of 198 replays on two threads were on cores far apart and do not count\n"), said[-99:])
        told = speed.two_threads(self.stored())
        self.assertIn("| - (- of 2.00) |", told)
        self.assertIn("; 6 of 198 replays on two threads were on cores far apart and do not count. Rock piles:", told)

    def test_solves_that_count_and_were_alone_are_refused(self):
        self.measure("--bodies", 200, STAND_IN_LATE_S=0.3)
        self.calls()
        said = self.measure("--bodies", 200, code=1, STAND_IN_LATE_S=0.5).stderr.splitlines()  # 15 cells, 3 solves of 8 ms in each
        self.assertEqual(sum(call.endswith("/replay1 --force") for call in self.calls()), 1 + 3)  # of 200 rocks, and again
        self.assertIn("solves side by side ended 0.5 s apart, so the last that count were alone", said[-2])
        self.assertIn("solves side by side were not at the same time, 3 times", said[-1])

    def test_bad_input_and_failures_are_one_line(self):
        self.check_least("--rounds", 3)
        self.check_refused((("--bodies", "300"), "--bodies has '300', expected some of 200,600,10000"))
        said = self.measure(code=1, STAND_IN_STATUS="not_converged").stderr.splitlines()[-1]
        self.assertRegex(said, r"replayed cells are not ok, first: step \d+, \S+ \S+: status not_converged")
        self.assertIn("exit code 1: cleave replay: no", self.run_it(code=1, stand_in_code=1).stderr.splitlines()[-1])
        self.assertFalse((self.directory / "out").exists())


class SharesTest(unittest.TestCase):

    def test_times_are_medians_over_the_rounds(self):
        share = thread_times.shares(stored_data.two_threads_rows())[0]
        self.assertEqual((share.one_ms, share.two_ms, share.beside_ms), (10, 6.25, 12.5))
        self.assertEqual((share.ratio, share.ceiling, share.share, share.measured), (1.6, 1.6, 1, False))

    def test_rounds_on_cores_far_apart_are_left_out(self):
        rows = [row | {"core_round_trip_ns": 510 if (row["threads"], row["round"]) == (2, 1) else 105} for row in stored_data.two_threads_rows()]
        share = thread_times.shares(rows)[0]
        self.assertEqual((share.one_ms, share.two_ms, share.far_rounds, share.rounds), (10, (6.25 + 1006.25) / 2, 1, 3))
        self.assertEqual(thread_times.far_in_words([share]), "1 of 3 replays on two threads were on cores far apart and do not count")
        self.assertEqual(thread_times.far_in_words(thread_times.shares(stored_data.two_threads_rows())), "")

    def test_a_way_that_is_missing_is_an_error(self):
        rows = [row for row in stored_data.two_threads_rows() if row["processes"] == 1 or row["step"] != 300]
        with self.assertRaisesRegex(ResultError, "large_rock_pile 600 1e-05 300 schur mindp none is not there with one thread,"):
            thread_times.shares(rows)

    def test_the_least_is_of_those_that_are_measured(self):
        shares = thread_times.shares(stored_data.two_threads_rows())
        found = thread_times.by_step(thread_times.of_scene(shares, "large_rock_pile"))
        self.assertEqual([(step, len(of_step)) for step, of_step in found.items()], [(100, 3), (300, 3)])
        least = thread_times.least(found[100])
        self.assertEqual((least.combination, least.share), ("mix+none", 0.9))  # mix+fm is less, below a low ceiling
        self.assertEqual(thread_times.least(found[300][2:]).combination, "mix+fm")


if __name__ == "__main__":
    unittest.main()
