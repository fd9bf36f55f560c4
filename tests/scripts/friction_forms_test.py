"""scripts/friction_forms: its slopes, and the command with a stand-in whose blocks obey closed forms, or do not."""
import csv
import math
import pathlib
import tomllib
import unittest

import numpy
from stand_in import NOTES_ITS_CALL, StandInCase

from cleave_scripts.measurements.friction_forms import (ANGLES_DEG, HOLDS, INCLINE_DEG, LIFTS, SPEEDS_M_PER_S,
                                                        closed_form_mu, normal_of)
from cleave_scripts.measurements.friction_of_models import MODELS

STAND_IN = NOTES_ITS_CALL + """import friction_forms_test
friction_forms_test.answer(given)
"""


def dot(one, other):
    return float(numpy.dot(one, other))


def angle_deg(normal):
    """Of the downhill direction against ODE's first tangent, by another way: the parts of gravity in the plane."""
    first = numpy.cross(normal, [1, 0, 0]) / numpy.linalg.norm(numpy.cross(normal, [1, 0, 0]))
    second = numpy.cross(normal, first)
    return math.degrees(math.atan2(abs(second[2]), abs(first[2])))


def answer(given):
    """As the program does: a block that slides below the coefficient, under the box by its axes, and lifts under the cone."""
    from synthetic import write_steps
    path = given["--scene"].removeprefix("file@path=")
    scene = tomllib.loads(pathlib.Path(path).read_text())
    normal, (speed, _, _) = numpy.array(scene["plane"][0]["normal"]), scene["body"][0]["velocity_m_per_s"]
    mu, steps, model = float(given["--mu"]), int(given["--steps"]), given["--friction"]
    angle = math.radians(angle_deg(normal)) if normal[2] < 1 else 0
    share = max(math.cos(angle), math.sin(angle)) if model.startswith("box") else 1
    slides = mu < math.tan(math.acos(normal[2])) * share
    lift = mu * speed / 60 if model == "cone" else 0
    write_steps(pathlib.Path(given["--out"]), [
        dict(seed=1, scene="file", bodies=1, step=step, rows=12, friction=model, t_s_ms=1, status="ok",
             last_body_z_m=0.05 + lift - 0.01 * step * slides) for step in range(steps)])


class SlopeTest(unittest.TestCase):

    def test_angles_and_incline(self):
        for angle in ANGLES_DEG:
            normal = normal_of(angle)
            self.assertAlmostEqual(dot(normal, normal), 1)
            self.assertAlmostEqual(math.degrees(math.acos(normal[2])), INCLINE_DEG)
            self.assertAlmostEqual(angle_deg(normal), angle)

    def test_the_box_is_up_to_the_root_of_two_too_strong(self):
        self.assertAlmostEqual(closed_form_mu("coulomb", 45) / closed_form_mu("box", 45), math.sqrt(2))
        self.assertAlmostEqual(closed_form_mu("box", 0), closed_form_mu("cone", 0))


class CommandTest(StandInCase):
    script, stand_in = "friction_forms", STAND_IN

    def test_coefficients_and_lifts_are_those_of_the_program_and_closed_forms_are_not(self):
        self.run_it()
        with open(self.directory / "out" / "friction_forms.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.check_holds([row for row in rows if row["form"] == HOLDS])
        self.check_lifts([row for row in rows if row["form"] == LIFTS])

    def check_holds(self, rows):
        self.assertEqual([(row["friction"], int(row["angle_deg"])) for row in rows],
                         [(model, angle) for model in MODELS for angle in ANGLES_DEG])
        for row in rows:
            self.assertAlmostEqual(float(row["mu"]), float(row["closed_form_mu"]), delta=2e-4, msg=row)

    def check_lifts(self, rows):
        self.assertEqual(len(rows), len(MODELS) * len(SPEEDS_M_PER_S))
        for row in rows:
            speed = float(row["speed_m_per_s"])
            told = 0.2 * speed / 60 if row["friction"] == "cone" else 0
            self.assertAlmostEqual(float(row["lift_m"]), told, places=12)
            exact = (0.2 * (speed - 0.2 * 9.81 / 60) / 60) / 1.04 if row["friction"] == "cone" else 0
            self.assertAlmostEqual(float(row["closed_form_lift_m"]), exact, places=12)

    def test_a_run_that_fails_is_one_line(self):
        self.program.write_text("#!/bin/sh\nexit 1\n")
        self.assertIn("exit code 1", self.run_it(code=1).stderr.splitlines()[-1])
        self.assertFalse((self.directory / "out" / "friction_forms.csv").exists())


if __name__ == "__main__":
    unittest.main()
