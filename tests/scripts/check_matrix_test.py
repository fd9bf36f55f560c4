"""check_matrix holds on a good matrix and names the criterion that fails on every way to spoil it."""
import tempfile
import unittest

from synthetic import matrix, run_script, write_matrix, write_steps


def spoil(**values):
    return lambda rows: rows[77].update(values)


# What is changed in the rows of one scene, and the line that has to fail.
SPOILED = {
    "status": (spoil(status="not_converged"), "status ok"),
    "residual": (spoil(residual_m_per_s=3e-9), "residual"),
    "residual nan": (spoil(residual_m_per_s="nan"), "residual"),
    "scale nan": (spoil(largest_free_velocity_m_per_s="nan"), "residual"),
    "scale infinite": (spoil(largest_free_velocity_m_per_s="inf"), "residual"),
    "spread": (spoil(velocity_spread_m_per_s=2e-8), "velocities of all combinations"),
    "spread nan": (spoil(velocity_spread_m_per_s="nan"), "velocities of all combinations"),
    "part too large": (spoil(max_part_bodies_before=26), "no part above"),
    "refined part too large": (spoil(refiner="fm", max_part_bodies=31), "no part above"),
    "refinement adds rows": (spoil(interface_rows=61), "refinement never adds"),
    "monolithic in disguise": (spoil(kernel="monolithic"), "kernel schur-rows"),
    "too many unknowns": (spoil(interface_unknowns=61), "kernel schur-rows"),
    "unknowns unmeasured": (spoil(interface_unknowns=-1), "kernel schur-rows"),
    "time nan": (spoil(t_s_ms="nan"), "times finite"),
    "stages beyond t_s": (spoil(t_s_other_ms=-1), "times finite"),
    "least above median": (spoil(t_s_min_ms=1000), "times finite"),
    "row lost": (lambda rows: rows[:77] + rows[78:], "15 combinations"),
    "row twice": (lambda rows: rows + rows[77:78], "15 combinations"),
    "another problem": (spoil(problem_hash="c"), "solve one problem"),
    "another state": (spoil(state_hash="c"), "solve one problem"),
    "scene lost": (lambda rows: [dict(row, scene="log_tower", seed=2) for row in rows], "every scene"),
    "too few steps": (lambda rows: matrix("rock_pile", range(9)), "enough measured steps"),
    "interface unused": (lambda rows: [row.update(interface_unknowns=0) for row in rows] and None,
                         "interface system is really used"),
    "nothing touches": (lambda rows: [row.update(contacts=0) for row in rows[20:]] and None, "contacts in"),
    "slow partitioning": (spoil(t_pr_ms=1000), "t_pr below the paper's"),
}


class CheckMatrixTest(unittest.TestCase):

    def check(self, change, *arguments):
        with tempfile.TemporaryDirectory() as directory:
            write_matrix(directory, change)
            return run_script("check_matrix", directory, *arguments)

    def test_a_good_matrix_holds(self):
        result = self.check(None)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertNotIn("FAIL", result.stdout)
        self.assertIn("600 rows checked", result.stdout)

    def test_the_residual_limit_grows_with_the_free_velocity(self):
        self.assertEqual(self.check(spoil(residual_m_per_s=2.4e-9)).returncode, 0)
        self.assertEqual(
            self.check(spoil(residual_m_per_s=1.1e-9, largest_free_velocity_m_per_s=0.5)).returncode, 3)

    def test_every_spoiled_matrix_fails_on_its_criterion(self):
        for name, (change, line) in SPOILED.items():
            with self.subTest(name):
                result = self.check(change)
                self.assertEqual(result.returncode, 3, result.stdout + result.stderr)
                self.assertTrue(
                    [text for text in result.stdout.splitlines() if text.startswith("FAIL") and line in text],
                    result.stdout)

    def test_the_first_offender_is_named(self):
        self.assertRegex(
            self.check(spoil(status="diverged")).stdout,
            r"FAIL.*1 found, first: .*rock_pile/steps.csv, line 79 \(rock_pile step 250, mindp fm\)")

    def test_a_shortened_matrix_can_be_checked(self):
        with tempfile.TemporaryDirectory() as directory:
            write_steps(directory, matrix("log_tower", [0, 1]))
            self.assertEqual(run_script("check_matrix", directory).returncode, 3)
            self.assertEqual(
                run_script("check_matrix", directory, "--scene", "log_tower", "--min-steps", 2).returncode, 0)

    def test_bad_input_is_one_line_and_exit_one(self):
        for change, words in ((lambda rows: [{
                "scene": "x"
        }], "missing column"), (spoil(interface_rows="many"), "column interface_rows is 'many'")):
            result = self.check(change)
            self.assertEqual(result.returncode, 1)
            self.assertIn(words, result.stderr)
            self.assertEqual(len(result.stderr.splitlines()), 1)


if __name__ == "__main__":
    unittest.main()
