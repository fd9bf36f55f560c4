"""scripts/two_threads with a stand-in for the program, and the shares that its rows become."""
import dataclasses
import os
import pathlib
import tempfile
import unittest
import unittest.mock

import stored_data
from measurements_test import Measurement

from cleave_scripts.documents import speed
from cleave_scripts.documents.stored import Stored
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
        solvers = [words[words.index("--solver") + 1] for words in replays]
        named = ("exact", "schur", "pgs-colored@sweeps=100")  # of piles, and of Large Rock Pile
        groups = [[words for words, solver in zip(replays, solvers) if name in solver.split(",")] for name in named]
        self.assertEqual(sum(map(len, groups)), len(replays))
        turn = [("1", "replay0"), ("2", "replay0")]
        beside = {("1", "replay0"), ("1", "replay1")}
        for calls in groups:
            found = [(words[words.index("--threads") + 1], words[words.index("--out") + 1].rpartition("/")[2])
                     for words in calls]
            self.assertEqual([found[:2], set(found[2:4]), set(found[4:6]), found[6:8], found[8:10], set(found[10:])],
                             [turn, beside, beside, turn[::-1], turn, beside])
            self.assertEqual(len({" ".join(words[:words.index("--threads")]) for words in calls}), 1)

            files = [pathlib.Path(word) for word in calls[0] if word.endswith(".h5")]
            self.assertEqual({files[0].name, files[-1].name}, {files[1].name})
            self.assertEqual([files[0].parent.name, files[-1].parent.name], ["before", "after0"])
        # Compliances of a pile and solvers; steps of Large Rock Pile, combinations and solvers that iterate.
        cells = 2 * 3 + 4 * (5 * 3 + 5)
        self.assertEqual(len(self.rows("two_threads.csv")), cells * 3 * 3)  # ways, rounds

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
        self.assertIn("| 300 | mindp+none | 8.00 | 2.00 | 1.82 | 1.10 | 0 | 15 | 15 |", said)
        self.assertIn("| 300 | apgd@sweeps=100 | 8.00 | 2.00 | 1.82 | 1.10 |", said)
        self.assertIn("| 200 | 1e-05 | 1.10 (2.00 of 1.82) | 1.10 (", speed.two_threads(self.stored()))

    def test_a_low_ceiling_is_no_measurement(self):
        said = self.measure("--bodies", 600, STAND_IN_BESIDE=1.5).stdout
        self.assertIn("| 600 | 1e-05 | exact | 8.00 | 2.00 | 1.60 | not measured: ceiling below 1.7 |", said)
        self.assertIn("| 8.00 | 2.00 | 1.60 | not measured: ceiling below 1.7 | 0 | 0 | 15 |", said)
        self.assertIn("| 600 | 1e-05 | - (2.00 of 1.60) | - (", speed.two_threads(self.stored()))

    def test_replays_on_cores_far_apart_do_not_count(self):
        said = self.measure("--bodies", 600, STAND_IN_APART=300).stdout
        self.assertIn("| 600 | 1e-05 | exact | 8.00 | - | 2.00 | not measured: cores far apart |", said)
        self.assertIn("| 600 | 1e-05 | pivot:schur-nested | 8.00 | 2.00 | 2.00 | 1.00 |", said)
        self.assertTrue(said.endswith("\n6 of 258 replays on two threads were on cores far apart and do not count\n"),
                        said[-99:])
        told = speed.two_threads(self.stored())
        self.assertIn("| - (- of 2.00) |", told)
        self.assertIn("; 6 of 258 replays on two threads were on cores far apart and do not count. Rock piles:", told)

    def test_solves_that_count_and_were_alone_are_refused(self):
        self.measure("--bodies", 200, STAND_IN_LATE_S=0.3)
        self.calls()
        # 15 cells, 3 solves of 8 ms in each: a core that is slower by more has more of them at the end.
        said = self.measure("--bodies", 200, STAND_IN_LATE_S=0.5).stderr
        self.assertIn("solves side by side ended 0.5 s apart, so the last that count were alone", said)
        self.assertEqual({call.count("/after") for call in self.calls() if call.startswith("replay")}, {1, 4})
        said = self.measure("--bodies", 200, code=1, STAND_IN_LATE_S=99).stderr.splitlines()
        self.assertEqual([call.count("/after") for call in self.calls() if call.endswith("/replay1 --force")], [1, 4, 16])
        self.assertIn("solves side by side ended 99 s apart, so the last that count were alone", said[-2])
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
        rows = [row | {"core_round_trip_ns": 510 if (row["threads"], row["round"]) == (2, 1) else 105}
                for row in stored_data.two_threads_rows()]
        share = thread_times.shares(rows)[0]
        self.assertEqual((share.one_ms, share.two_ms, share.far_rounds, share.rounds), (10, (6.25 + 1006.25) / 2, 1, 3))
        self.assertEqual(thread_times.far_in_words([share]),
                         "1 of 3 replays on two threads were on cores far apart and do not count")
        self.assertEqual(thread_times.far_in_words(thread_times.shares(stored_data.two_threads_rows())), "")

    def test_a_way_that_is_missing_is_an_error(self):
        rows = [row for row in stored_data.two_threads_rows() if row["processes"] == 1 or row["step"] != 300]
        with self.assertRaisesRegex(ResultError,
                                    "large_rock_pile 600 1e-05 300 schur mindp none is not there with one thread,"):
            thread_times.shares(rows)

    def test_the_least_is_of_those_that_are_measured(self):
        shares = thread_times.shares(stored_data.two_threads_rows())
        found = thread_times.by_step(thread_times.large_rock_pile(shares)[0])
        self.assertEqual([(step, len(of_step)) for step, of_step in found.items()], [(100, 3), (300, 3)])
        least = thread_times.least(found[100])
        self.assertEqual((least.combination, least.share), ("mix+none", 0.9))  # mix+fm is less, below a low ceiling
        self.assertEqual(thread_times.least(found[300][2:]).combination, "mix+fm")

    def test_those_below_what_was_asked_are_counted_among_those_that_are_measured(self):
        slow = ("large_rock_pile", 600, 1e-5, 100, "schur", "mr", "none")
        shares = thread_times.shares(stored_data.two_threads_rows(stored_data.TIMES | {slow: (100, 70, 100)}))
        found = [thread_times.counts(of_step)
                 for of_step in thread_times.by_step(thread_times.large_rock_pile(shares)[0]).values()]
        self.assertEqual(found, [thread_times.Counts(below=1, measured=3, combinations=4), thread_times.Counts(0, 2, 3)])

    def test_solvers_that_iterate_stand_apart_and_are_held_against_what_was_asked(self):
        root = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        stored_data.write_csv(root / "two_threads.csv",
                              stored_data.two_threads_rows(stored_data.TIMES | stored_data.SWEEPS_TIMES))
        stored_data.write_provenance(root, "two_threads.csv")
        told = speed.two_threads(Stored(root))
        self.assertIn("| 100 | `mix+none` 0.90 (1.80 of 2.00) | 0 | 2 | 3 |\n", told)  # as without them
        self.assertIn("|  | step 100 | step 300 | asked of every step |\n", told)
        self.assertIn("| `pgs-colored@sweeps=100` | 0.80 (1.60 of 2.00) | 0.88 (1.60 of 1.82) | 0.75, holds |\n", told)
        self.assertIn("| `apgd@sweeps=100` | - (1.00 of 1.00) | - (1.00 of 0.91) | - |", told)

    def test_a_share_that_is_too_small_does_not_hold_and_one_that_is_not_measured_neither(self):
        slow = {key: (20, two, beside) for key, (_, two, beside) in stored_data.SWEEPS_TIMES.items()} | {
            ("large_rock_pile", 600, 1e-5, 300, "pgs-colored@sweeps=100", "-", "-"): (20, 14, 20)}
        sweeps = thread_times.large_rock_pile(thread_times.shares(stored_data.two_threads_rows(slow)))[1]
        self.assertEqual(thread_times.verdict([share for share in sweeps if share.solver.startswith("pgs-colored")]),
                         "0.75, does not hold")
        alone = [dataclasses.replace(sweeps[0], beside_ms=30)]
        self.assertEqual(thread_times.verdict(alone), "0.75, not measured")


if __name__ == "__main__":
    unittest.main()
