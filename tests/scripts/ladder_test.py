"""scripts/ladder with a stand-in for the program, and its closed forms."""
import contextlib
import csv
import io
import math
import os
import pathlib
import runpy
import tempfile
import unittest

from synthetic import PROGRAM, ROOT, SCRIPTS, run_script

from cleave_scripts.ladder import rungs
from cleave_scripts.ladder.climbers import CLIMBERS, climber_of
from cleave_scripts.ladder.cells import COLUMNS

# Fails as STAND_IN says of a solver: "pgs=crash ode-step=sleep".
STAND_IN = f"""#!/usr/bin/python3
import os, pathlib, sys
sys.path.insert(0, {str(ROOT / "tests" / "scripts")!r})
import stand_in_key
import stand_in_sweep
stand_in_sweep.answer()
from synthetic import write_manifest, write_steps
given = dict(zip(sys.argv[2::2], sys.argv[3::2]))
with open(os.environ["STAND_IN_LOG"], "a") as log:
    log.write(" ".join(sys.argv[1:]) + "\\n")
told = dict(word.split("=") for word in os.environ["STAND_IN"].split()).get(given["--solver"].partition("@")[0], "ok")
out, h = pathlib.Path(given["--out"]), float(given["--dt"])
out.mkdir(parents=True, exist_ok=True)
if told == "slow":
    sys.exit(124)
if told == "interrupt":
    sys.exit(130)
def row(step):
    fallen = -9.81 * h * h * (step + 1) * (step + 2) / 2
    status = {{"late": "not_converged" if step == 1 else "ok",
               "refused": "refused" if step == 0 else "skipped"}}.get(told, "ok")
    return {{"step": step, "status": status, "status_reason": "too many rows" if step == 0 else "-",
             "residual_m_per_s": 1e-12 * step, "iterations": step, "joint_drift_m": int(told == "open"), "max_penetration_m": 0,
             "energy_excess_j": 0, "kinetic_energy_j": 1, "last_body_z_m": fallen + (1 if told == "high" else 0),
             "t_s_ms": step, "rows": 0, "ode_messages": 1}}
write_steps(out, [row(step) for step in range(int(given["--steps"]))])
write_manifest(out, state="failed" if told == "thrown" else "complete",
               result={{"inexact_advances": int(told == "inexact")}})
if told == "thrown":
    (out / "manifest.json").unlink()
    sys.exit("cleave run: ODE: assertion")
sys.exit(0 if told == "ok" else 2)
"""


class LadderTest(unittest.TestCase):

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.directory = pathlib.Path(scratch.name)
        self.out = self.directory / "out"
        self.log = self.directory / "log"
        self.log.touch()
        self.program = self.directory / "cleave"
        self.program.write_text(STAND_IN)
        self.program.chmod(0o755)

    def environment(self, told):
        return dict(os.environ, CLEAVE_PROGRAM=str(self.program), STAND_IN_REAL=PROGRAM, STAND_IN_LOG=str(self.log),
                    STAND_IN=told)

    def ladder(self, *arguments, told="", code=0):
        result = run_script("ladder",
                            "--out",
                            self.out,
                            "--rung",
                            "no_contact",
                            "--steps",
                            4,
                            *arguments,
                            env=self.environment(told))
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result

    def rows(self):
        with open(self.out / "ladder.csv", newline="") as file:
            return list(csv.DictReader(file))

    def calls(self):
        lines = self.log.read_text().splitlines()
        self.log.write_text("")
        return lines

    def test_every_solver_advances_a_world_of_its_own(self):
        self.ladder()
        rows, calls = self.rows(), self.calls()
        self.assertEqual(len(rows), 2 * len(CLIMBERS))
        self.assertEqual(tuple(rows[0]), COLUMNS)
        self.assertEqual({(row["status"], row["physics"], row["first_failing"], row["setup"])
                          for row in rows}, {("ok", "ok", "-", "-")})
        self.assertTrue(all("--mode separate" in call for call in calls))
        self.assertEqual(len(set(calls)), len(rows))

    def test_a_row_holds_the_worst_of_its_steps(self):
        self.ladder("--solver", "exact", told="exact=late")
        row = self.rows()[0]
        self.assertEqual((row["rung"], row["parameter"], row["value"], row["solver"], row["status"]),
                         ("no_contact", "boxes", "1", "exact", "not_converged"))
        self.assertEqual((row["residual_m_per_s"], row["iterations"], row["t_s_ms"], row["ode_messages"]),
                         ("3e-12", "3.0", "1.5", "4"))
        self.assertLess(float(row["height_error_m"]), 1e-15)

    def test_a_failure_is_a_row_with_its_status_and_reason(self):
        told = "monolithic=slow pgs=thrown ode-step=refused ode-quickstep=high"
        solvers = "monolithic,pgs_20,ode-step,ode-quickstep_20"
        self.ladder("--solver", solvers, "--timeout", 3, told=told)
        found = {row["solver"]: row for row in self.rows() if row["value"] == "10"}
        self.assertEqual({solver: (row["status"], row["physics"])
                          for solver, row in found.items()}, {
                              "monolithic": ("timeout", "-"),
                              "pgs_20": ("crashed", "-"),
                              "ode-step": ("refused", "-"),
                              "ode-quickstep_20": ("ok", "height")
                          })
        self.assertEqual(found["pgs_20"]["status_reason"], "cleave run: ODE: assertion")
        self.assertEqual(found["ode-step"]["status_reason"], "too many rows")
        self.assertEqual(found["ode-step"]["residual_m_per_s"], "nan")
        self.assertEqual([row["first_failing"] for row in self.rows()], ["1", "1", "1", "-"] * 2)
        self.assertEqual(found["ode-quickstep_20"]["first_failing_physics"], "1")

    def test_a_stack_says_its_set_up_and_tells_it_to_the_program(self):
        self.ladder("--rung", "stack,stack_off_axis", "--solver", "ode-step_pyramid")
        self.assertEqual({(row["rung"], row["setup"])
                          for row in self.rows()}, {("stack", "on_axis"), ("stack_off_axis", "off_axis")})
        calls = self.calls()
        off_axis = [call for call in calls if "--offset-m 1e-3" in call]
        self.assertEqual(len(off_axis) * 2, len(calls))
        for call in off_axis:
            for words in ("--overlap-m 1e-6", "--layer-m 5e-7"):
                self.assertIn(words, call)
        for call in calls:
            self.assertIn("@ode-friction=pyramid ", call)

    def test_what_a_too_long_step_breaks_is_named_so(self):
        rungs = ("--rung", "chain_swing,chain_swing_short_step", "--solver", "exact")
        self.ladder(*rungs, told="exact=open")
        found = {(row["rung"], row["value"]): row["physics"] for row in self.rows()}
        self.assertEqual(found["chain_swing", "1"], "drift")
        self.assertEqual(found["chain_swing", "100"], "step_too_long")
        self.assertEqual(found["chain_swing_short_step", "100"], "drift")
        self.ladder(*rungs, "--steps", 5)
        self.assertEqual({row["physics"] for row in self.rows()}, {"ok"})

    def test_an_inexact_advance_between_exact_rows_counts(self):
        self.ladder("--solver", "exact", told="exact=inexact")
        self.assertEqual(self.rows()[0]["status"], "not_converged")

    def test_finished_cells_are_kept_and_those_without_time_tried_again(self):
        self.ladder("--solver", "exact,pgs_20", told="pgs=slow")
        self.assertEqual([row["status"] for row in self.rows()], ["ok", "timeout"] * 2)
        self.assertEqual(len(self.calls()), 4)
        self.ladder("--solver", "exact,pgs_20")
        self.assertEqual(len(self.calls()), 2)
        self.assertEqual([row["status"] for row in self.rows()], ["ok"] * 4)
        self.ladder("--solver", "exact,pgs_20", "--force")
        self.assertEqual(len(self.calls()), 4)

    def test_an_interrupted_ladder_leaves_no_table_and_goes_on(self):
        result = self.ladder("--solver", "exact,pgs_20", told="pgs=interrupt", code=130)
        self.assertIn("goes on", result.stderr)
        self.assertFalse((self.out / "ladder.csv").exists())
        self.calls()
        self.ladder("--solver", "exact,pgs_20")
        self.assertEqual(len(self.calls()), 3)
        self.assertEqual(sorted(path.name for path in self.out.iterdir()), ["ladder.csv", "ladder_cells"])

    def test_a_run_that_two_rungs_have_in_common_is_made_once_and_stands_in_both(self):
        self.ladder("--rung", "contact_cap,duplicates", "--solver", "exact")
        self.assertEqual(len(self.rows()), len(self.calls()) + 1)

    def test_a_solver_that_says_its_strategy_or_parameters_climbs_too_and_after_those_of_the_list(self):
        self.ladder("--solver", "pgs@sweeps=30,pivot:schur-bodies,monolithic,exact")
        names = ["exact", "monolithic", "pgs@sweeps=30", "pivot:schur-bodies"]
        self.assertEqual(list(dict.fromkeys(row["solver"] for row in self.rows())), names)
        self.assertEqual({call.partition("--solver ")[2].partition(" ")[0] for call in self.calls()}, set(names))

    def test_climbers_of_the_list_have_their_parameters(self):
        self.assertEqual((climber_of("pgs_200").solver, climber_of("pgs_200").friction), ("pgs@sweeps=200", "box"))
        self.assertEqual((climber_of("exact_cone").solver, climber_of("exact_cone").friction), ("exact", "cone"))
        self.ladder("--solver", "exact,exact_cone,pgs_20")
        self.assertEqual(sorted({tuple(call.split()[call.split().index(name) + 1] for name in ("--solver", "--friction"))
                                 for call in self.calls()}),
                         [("exact", "box"), ("exact", "cone"), ("pgs@sweeps=20", "box")])

    def test_the_summary_tells_values_as_they_are_written(self):
        row = {"rung": "time_step", "parameter": "dt", "solver": "exact", "first_failing": repr(1 / 60),
               "first_failing_physics": "-"}
        with contextlib.redirect_stdout(io.StringIO()) as told:
            runpy.run_path(str(SCRIPTS / "ladder"))["print_summary"]([row])
        self.assertEqual(told.getvalue().splitlines()[1], "time_step (dt)       0.016666666666666666 / -")

    def test_bad_input_is_one_line_and_leaves_nothing(self):
        for arguments in (("--rung", "heavy"), ("--solver", "pgs"), ("--solver", "exact,pgs"), ("--steps", "0"),
                          ("--timeout", "nan"), ("--jobs", "x")):
            result = self.ladder(*arguments, code=1)
            self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
            self.assertIn(arguments[0], result.stderr)
        self.assertFalse(self.out.exists())
        self.assertIn("--solver: 'nope:nope' is unknown", self.ladder("--solver", "nope:nope", code=1).stderr)
        self.assertFalse(self.out.exists())


class ClosedFormTest(unittest.TestCase):

    def expected(self, name, value, steps=10**6, **changes):
        rung = next(rung for rung in rungs.RUNGS if rung.name == name)
        return rung.expect({**rung.settings(value), **changes}, steps)

    def test_the_heavy_box_sags_by_the_sum_over_the_interfaces(self):
        sag = sum(1e-10 * 9.81 * (1e6 + light) / 60 / (0.2 * 4) for light in range(6))
        aim = self.expected("heavy_top", "1e6")
        self.assertAlmostEqual(aim.sag_m, sag, delta=1e-18)
        self.assertAlmostEqual(aim.height_m, 5.5 - sag, delta=1e-15)
        self.assertLess(sag, 1e-3)

    def test_the_sag_grows_step_by_step_and_without_end_where_erp_is_zero(self):
        settings = {"erp": "0.2", "cfm": "1e-5", "dt": "0.01"}
        depth = 0
        for steps in range(1, 30):
            depth += 1e-5 * 50 * 0.01 / 4 - 0.2 * depth
            self.assertAlmostEqual(rungs.depth_m(50, 4, settings, steps), depth, delta=1e-18)
        self.assertAlmostEqual(rungs.depth_m(50, 4, {**settings, "erp": "0"}, 7), 7 * 1.25e-6)

    def test_a_soft_stack_off_its_axis_has_no_height_for_it_leans(self):
        soft, stiff = (self.expected("stiffness_off_axis", cfm) for cfm in ("1e-2", "1e-3"))
        self.assertTrue(math.isnan(soft.height_m))
        self.assertEqual(soft.depth_m, self.expected("stiffness", "1e-2").depth_m)
        self.assertEqual(stiff.height_m, self.expected("stiffness", "1e-3").height_m)
        self.assertFalse(math.isnan(self.expected("stiffness", "1e-2").height_m))

    def test_duplicates_share_the_load(self):
        once, twice = (self.expected("duplicates", copies) for copies in "12")
        weight = 1e-5 * 9.81 / 60 / (0.2 * 4)
        self.assertAlmostEqual(once.sag_m, 15 * weight)
        self.assertAlmostEqual(twice.sag_m, (5 / 2 + 10 / 4) * weight)

    def test_a_box_holds_or_slides(self):
        self.assertAlmostEqual(self.expected("friction", "0.5", cfm="0").height_m, 0.4829629, places=6)
        slow = self.expected("friction", "0", steps=60, cfm="0").height_m
        self.assertAlmostEqual(slow, 0.4829629 - 9.81 * 0.0669873 * 61 * 60 / 3600 / 2, places=5)

    def test_the_longest_step_of_a_swinging_chain(self):
        """The highest mode of a taut row of rods, by Rayleigh's quotient of the zigzag."""
        links, mass, length, tension = 10, 1.0, 0.3, 9.81 * 109
        amplitude = 0.01
        bent = tension * (2 * amplitude)**2 / (2 * length) * links
        moving = mass * amplitude**2 / 3 / 2 * links
        rung = next(rung for rung in rungs.RUNGS if rung.name == "chain_swing_short_step")
        step_s = float(rung.settings("100")["dt"])
        self.assertAlmostEqual(step_s * math.sqrt(bent / moving), 1)
        self.assertAlmostEqual(self.expected("chain_swing", "100").longest_step_s, 2 * step_s)
        self.assertEqual(float(rung.settings("1")["dt"]), rungs.longest_step_s(rung.settings("1")) / 2)
        self.assertEqual(rung.settings("1")["links"], "10")

    def test_a_short_step_is_never_longer_than_the_usual_one(self):
        for name in ("chain_swing", "chain_swing_short_step"):
            rung = next(rung for rung in rungs.RUNGS if rung.name == name)
            for value in rung.values:
                self.assertLessEqual(float(rung.settings(value)["dt"]), 1 / 60)

    def test_every_stack_has_both_set_ups_which_differ_in_nothing_else(self):
        by_name = {rung.name: rung for rung in rungs.RUNGS}
        self.assertEqual(len(by_name), len(rungs.RUNGS))
        stacks = [rung for rung in by_name.values() if rung.setup == "on_axis"]
        self.assertEqual([rung.name for rung in stacks], list(rungs.STACKS))
        for rung in stacks:
            twin = by_name[rung.name + "_off_axis"]
            self.assertEqual(twin.setup, "off_axis")
            for value in rung.values:
                self.assertEqual({**rung.settings(value), "overlap-m": "1e-6", "layer-m": "5e-7", "offset-m": "1e-3"},
                                 twin.settings(value))
            self.assertEqual((rung.values, rung.quick, rung.expect), (twin.values, twin.quick, twin.expect))

    def test_a_chain_is_open_widest_at_its_top(self):
        aim = self.expected("chain_bob", "1e6")
        self.assertAlmostEqual(aim.joint_gap_m, 1e-10 * 9.81 * (1e6 + 9) / 60 / 0.2)
        self.assertAlmostEqual(aim.height_m, 1.15 - aim.sag_m)

    def test_quick_values_are_some_of_the_full_ones_in_their_order(self):
        for rung in rungs.RUNGS:
            self.assertEqual([value for value in rung.values if value in rung.quick], list(rung.quick),
                             rung.name)
            self.assertEqual(len(set(rung.values)), len(rung.values), rung.name)


if __name__ == "__main__":
    unittest.main()
