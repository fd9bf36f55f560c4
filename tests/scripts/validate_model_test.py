"""The modelled two-thread time against the measured one, from made-up rows."""
import pathlib
import tempfile
import unittest

from synthetic import good_row, run_script, write_steps


def rows_of(threads, steps, **columns):
    """mindp+none and mix+fm on some steps; a column may be a function of the step."""
    rows = []
    for step in steps:
        for names in (("mindp", "none"), ("mix", "fm")):
            values = {name: value(step) if callable(value) else value for name, value in columns.items()}
            made = good_row("rock_pile", step, *names) | {"t_s_model_p2_ms": "nan", "threads": threads}
            rows.append(made | values)
    return rows


class ValidateModelTest(unittest.TestCase):

    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)
        self.directory = pathlib.Path(self.scratch.name)

    def validate(self, one, two, *options, code=0):
        write_steps(self.directory / "one", one)
        write_steps(self.directory / "two", two)
        result = run_script("validate_model", self.directory / "one", self.directory / "two", *options)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        self.assertNotIn("Traceback", result.stderr)
        return result.stderr if code == 1 else result.stdout

    def test_median_and_quartiles_of_known_ratios(self):
        steps = (0, 1, 2, 3, 4)
        text = self.validate(rows_of(1, steps, t_s_model_p2_ms=lambda step: 4 + step),
                             rows_of(2, steps, t_s_ms=8))
        # Modelled 4, 5, 6, 7, 8 ms where 8 were measured.
        for name, pairs in (("mindp none schur", 5), ("mix fm schur", 5)):
            self.assertRegex(text, rf"(?m)^{name} +{pairs} +0\.625 +0\.750 +0\.875$")
        self.assertRegex(text, r"(?m)^all +10 ")
        self.assertIn("0 rows without a partner", text)

    def test_only_solved_rows_of_the_same_problem_are_compared(self):
        one = rows_of(1, (0, 1, 2), t_s_model_p2_ms=6)
        two = rows_of(2, (1, 2, 3), t_s_ms=6)
        two[0].update(status="not_converged", t_s_ms="nan")  # mindp none of step 1
        text = self.validate(one, two)
        self.assertRegex(text, r"(?m)^mindp none schur +1 +1\.000 +1\.000 +1\.000$")
        self.assertRegex(text, r"(?m)^mix fm schur +2 ")
        self.assertIn("5 rows without a partner", text)

    def test_the_median_has_to_lie_within_the_limit(self):
        one, two = rows_of(1, (0, 1, 2), t_s_model_p2_ms=6), rows_of(2, (0, 1, 2), t_s_ms=8)
        for limit, code, word in (("0.7,0.8", 0, "pass"), ("0.75,0.75", 0, "pass"), ("0.8,1.2", 3, "FAIL"),
                                  ("0,0.7", 3, "FAIL")):
            self.assertIn(f"\n{word}  median 0.750, limits ", self.validate(one, two, "--limit", limit, code=code))
        for wrong in ("1", "a,b", "2,1", "0,nan", "1,2,3"):
            self.assertIn(f"--limit is '{wrong}', expected LOW,HIGH", self.validate(one, two, "--limit", wrong, code=1))

    def test_pairs_that_waited_for_a_core_are_left_out_and_counted(self):
        one, two = rows_of(1, (0, 1, 2), t_s_model_p2_ms=6, t_s_ms=10), rows_of(2, (0, 1, 2), t_s_ms=8)
        one[0].update(t_s_waiting_ms=0.6)  # mindp none of step 0
        two[2].update(t_s_waiting_ms=0.5, t_s_ms=1)  # mindp none of step 1
        two[4].update(t_s_waiting_ms="nan")  # nobody knows
        two[5].update(t_s_waiting_ms=0.3)  # less than 5 %
        text = self.validate(one, two)
        self.assertRegex(text, r"(?m)^mindp none schur +1 +0\.750")
        self.assertRegex(text, r"(?m)^mix fm schur +3 +0\.750")
        self.assertIn("\n0 rows without a partner left out\n2 pairs that waited more than 5 % of t_s", text)
        for row in two:
            row.update(t_s_waiting_ms=4)
        self.assertIn("all 6 pairs waited for a core", self.validate(one, two, code=1))

    def test_without_pairs_it_fails_loudly(self):
        error = self.validate(rows_of(1, (0,), t_s_model_p2_ms=6), rows_of(2, (1,)), code=1)
        self.assertIn("no problem that both solved", error)
        self.assertEqual(len(error.splitlines()), 1)

    def test_wrong_threads_and_unmodelled_rows_are_refused(self):
        modelled = rows_of(1, (0,), t_s_model_p2_ms=6)
        self.assertIn("no row of status ok with threads 2", self.validate(modelled, rows_of(1, (0,)), code=1))
        self.assertIn("t_s_model_p2_ms is 'nan'", self.validate(rows_of(1, (0,)), rows_of(2, (0,)), code=1))
        self.assertIn("t_s_model_p2_ms is '-3'",
                      self.validate(rows_of(1, (0,), t_s_model_p2_ms=-3), rows_of(2, (0,)), code=1))

    def test_a_cell_given_twice_is_refused(self):
        twice = 2 * rows_of(1, (0,), t_s_model_p2_ms=6)
        self.assertIn("stand already in", self.validate(twice, rows_of(2, (0,)), code=1))


if __name__ == "__main__":
    unittest.main()
