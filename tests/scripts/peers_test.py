"""scripts/peers: what is made of its rows, and the command with a stand-in for all three programs."""
import csv
import json
import os
import pathlib
import unittest
import unittest.mock

import h5py
import numpy
import stored_data
from stand_in import NOTES_ITS_CALL, StandInCase

from cleave_scripts.documents import peers
from cleave_scripts.documents.stored import Stored
from cleave_scripts.measurements.peer_times import COLUMNS, MUJOCO, PEERS, STEPS, growth, markdown, prices, table, verdict

STAND_IN = NOTES_ITS_CALL + """import peers_test
peers_test.answer(words, given)
"""
TIMES_MS = {"exact": 1, "bullet-dantzig": 3000, "dart-dantzig": "nan", "ipopt@peer-tolerance=1e-8": 11}
STATUSES = {"exact": "ok", "bullet-dantzig": "ok", "dart-dantzig": "timeout"}


def write_pile(path):
    """A ball on the ground, as far as a model of MuJoCo needs it."""
    with h5py.File(path, "w") as file:
        file.attrs["h_s"] = 0.01
        for name, value in (("mass", [numpy.eye(6)]), ("free_velocity", numpy.zeros((1, 6))), ("position", [[0, 0, 1]]),
                            ("row_kind", [1, 2, 2]), ("orientation", [[1, 0, 0, 0]]), ("friction_coefficient", [0, 0.5, 0.5])):
            file[name] = numpy.array(value, dtype=float)
        for name, value in (("body", [0, -1]), ("type", [1, 5]), ("size", [[1, 0, 0], [0, 0, 0]]),
                            ("position", [[0, 0, 1], [0, 0, 0]]), ("orientation", [[1, 0, 0, 0]] * 2)):
            file[f"shape/geom_{name}"] = numpy.array(value)


def answer(words, given):
    """As the programs do: Bullet's Dantzig takes longer than the rest, DART's longer than it may."""
    from synthetic import touch_recorded, write_steps
    if words[0].endswith(".xml"):
        return print(json.dumps({"contacts": 1, "rows": 4, "t_constraint_ms": 8, "t_step_ms": 16}))
    if words[0] == "record":
        touch_recorded(given)
        for path in pathlib.Path(given["--out"]).iterdir():
            write_pile(path)
        return None
    path, = (pathlib.Path(word) for word in words if word.endswith(".h5"))
    bodies = int(path.parent.name.removeprefix("rocks_"))
    rows = [dict(scene="rock_pile", bodies=bodies, step=int(path.stem[-6:]), rows=10 * bodies, solver=solver,
                 status=STATUSES.get(solver, "not_converged"), residual_m_per_s=1e-5, t_s_ms=TIMES_MS.get(solver, 20),
                 peer_timeout_s=given.get("--peer-timeout-s", "-"))
            for solver in given["--solver"].split(",")]
    return write_steps(given["--out"], rows)


def row(solver, t_s_ms, **given):
    return dict(scene="rock_pile", bodies="200", step="300", round=1, rows="2000", solver=solver, status="ok",
                residual_m_per_s="1e-12", t_s_ms=str(t_s_ms), peer_timeout_s="300") | given


def rows_of(bodies, exact_ms, others):
    return [row(solver, t_s_ms, bodies=str(bodies), rows=str(10 * bodies), **given)
            for solver, t_s_ms, given in [("exact", exact_ms, {}), *((solver, 1, {}) for solver in MUJOCO), *others]]


class PricesTest(unittest.TestCase):

    def test_medians_are_over_the_rounds_of_a_step_and_then_over_the_steps(self):
        rows = [row(solver, t_s_ms, round=number, step=step)
                for step, exact_ms, other_ms in (("300", (1, 2, 90), (8, 8, 8)), ("350", (1, 1, 1), (5, 6, 7)),
                                                 ("400", (1, 1, 1), (5, 5, 5)))
                for number in range(3) for solver, t_s_ms in (("exact", exact_ms[number]), ("ipopt", other_ms[number]))]
        price = prices(rows)[200]["ipopt"]
        self.assertEqual((price.t_s_ms, price.against_ours, price.is_least), (6, 5, False))
        self.assertEqual(price.status_in_words(), "ok")

    def test_a_solve_that_was_ended_took_at_least_its_limit(self):
        price = prices([row("exact", 1), row("dart", "nan", status="timeout", residual_m_per_s="nan"),
                        row("exact", 1, step="400"), row("dart", 2000, step="400")])[200]["dart"]
        self.assertEqual((price.said(price.t_s_ms), price.said(price.against_ours)), ("at least 151000", "at least 151000"))
        self.assertEqual((price.status_in_words(), price.residual_m_per_s), ("timeout 1 of 2, ok 1 of 2", 1e-12))

    def test_a_solve_without_a_time_counts_as_none(self):
        price = prices([row("exact", 1), row("lemke", "nan", status="crashed")])[200]["lemke"]
        self.assertEqual((price.said(price.t_s_ms), verdict(price, 12)), ("-", "not measured (crashed)"))

    def test_verdicts_say_at_least_and_what_cannot_be_told(self):
        for solver, ms, given, word in (("a", 2000, {}, "holds"), ("a", 1999, {}, "does not hold"),
                                        ("a", "nan", {"status": "timeout"}, "holds"),
                                        ("a", "nan", {"status": "timeout", "peer_timeout_s": "1"},
                                         "cannot be told, as it was ended")):
            price = prices([row("exact", 1), row(solver, ms, **given)])[200][solver]
            self.assertEqual(verdict(price, 2000), word)

    def test_growth_is_the_power_between_two_piles(self):
        ended = {"status": "timeout"}
        found = prices(rows_of(20, 1, [("a", 1, {}), ("b", 1, {}), ("c", "nan", ended), ("d", "nan", {})]) +
                       rows_of(200, 10, [("a", 1000, {}), ("b", "nan", ended), ("c", "nan", ended), ("d", 1, {})]))
        self.assertEqual([growth(found[20][solver], found[200][solver]) for solver in ("exact", "a", "b", "c", "d")],
                         ["1.0", "3.0", "at least 5.5", "-", "-"])
        self.assertEqual(growth(found[20]["a"], found[20]["a"]), "-")

    def test_the_table_has_a_pile_in_two_columns_and_the_smallest_first(self):
        lines = table(prices(rows_of(200, 2, [("a", 50, {"status": "not_converged"})]) +
                             rows_of(80, 1, [("a", 5, {})]))).splitlines()
        self.assertIn("|  | 80 rocks, 800 rows: ms (times `exact`) | residual, m/s (status) | "
                      "200 rocks, 2000 rows: ms", lines[0])
        self.assertEqual(lines[-1], "| `a` | 5.00 (5.00) | 1.0e-12 (ok) | 50.0 (25.0) | 1.0e-12 (not_converged) | 2.5 |")
        self.assertIn("| `mujoco-step` | 1.00 (1.00) | another model | 1.00 (0.500) | another model |", lines[4])

    def test_sentences_are_of_the_asked_pile_alone(self):
        others = [(solver, ms, {})
                  for solver, ms in (("bullet-dantzig", 2100), ("dart-dantzig", 1900), ("ipopt@peer-tolerance=1e-8", 12))]
        told = markdown(rows_of(200, 1, others))[1].splitlines()
        self.assertEqual([line.rpartition(": ")[2] for line in told[:3]], ["holds.", "does not hold.", "holds."])
        self.assertIn("MuJoCo's constraints take 1.00 times", told[3])
        self.assertEqual(markdown(rows_of(80, 1, others))[1], "")


class PeersTest(StandInCase):
    stand_in, script = STAND_IN, "peers"

    def setUp(self):
        super().setUp()
        self.enterContext(unittest.mock.patch.dict(os.environ, CLEAVE_PEERS=str(self.program), CLEAVE_MUJOCO=str(self.program)))

    def rows(self):
        with open(self.directory / "out" / "peer_times.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(tuple(rows[0]), COLUMNS)
        return rows

    def test_all_take_turns_and_what_is_slow_is_solved_once(self):
        said = self.run_it("--bodies", "200,30", "--rounds", "2", "--timeout", "120").stdout
        recorded, calls = [], self.calls()
        while calls[0].startswith("record "):
            recorded.append(calls.pop(0))
        self.assertEqual([call.split(" --advance")[0] for call in recorded],
                         [f"record --scene rock_pile --at 300,350,400 --bodies {bodies}" for bodies in (30, 200)])
        self.assertEqual(len(calls), 2 * 2 * len(STEPS) * 3)
        self.assertIn("--solver exact --threads 1 --repeats 5 ", calls[0])
        self.assertIn(f"--solver {','.join(PEERS)} --threads 1 --repeats 1 --peer-max-rows 5000 --peer-timeout-s 120 ",
                      calls[1])
        self.assertTrue(calls[2].endswith("pile.xml 5 1"))
        quick = ",".join(solver for solver in PEERS if not solver.endswith("dantzig"))
        self.assertIn(f"--solver {quick} --threads 1", calls[3 * 2 * len(STEPS)])
        self.assertIn("--solver exact ", calls[3 * 2 * len(STEPS) + 1])
        rows = self.rows()
        self.assertEqual(len(rows), 2 * len(STEPS) * (2 * (1 + len(PEERS) + len(MUJOCO)) - 2))
        self.assertEqual([rows[8][name] for name in ("bodies", "step", "rows", "solver", "status", "t_s_ms")],
                         ["30", "300", "4", "mujoco-constraint", "-", "8"])
        self.assertIn("| `dart-dantzig` | at least 120000 (at least 120000) | 1.0e-5 (timeout) |", said)
        self.assertIn("- `bullet-dantzig` takes 3000 times as long as `exact` on 200 rocks and solves 3 of 3 steps exactly; "
                      "asked: at least 2000 times: holds.", said)
        self.assertIn("`ipopt@peer-tolerance=1e-8` takes 11.0 times as long as `exact` on 200 rocks and solves 0 of 3 steps "
                      "exactly; asked: at least 12 times: does not hold.", said)

    def test_the_document_tells_them(self):
        self.run_it("--bodies", "200", "--rounds", "1")
        stored_data.write_provenance(self.directory / "out", "peer_times.csv")
        told = peers.peer_times(Stored(self.directory / "out"))
        for words in ("steps 300, 350 and 400 of", "Some CPU, 2 cores", "median of 1 rounds",
                      "| `exact` | 1.00 (1.00) | 1.0e-5 (ok) | - |",
                      "- MuJoCo's constraints take 8.00 times as long as `exact` on 200 rocks, its whole step 16.0 times"):
            self.assertIn(words, told)

    def test_a_bad_option_or_a_program_that_is_not_there_is_one_line(self):
        self.check_refused((("--bodies", "401"), "--bodies has '401'"), (("--timeout", "0"), "--timeout is '0'"))
        for variable in ("CLEAVE_PEERS", "CLEAVE_MUJOCO"):
            with unittest.mock.patch.dict(os.environ, {variable: "/nowhere"}):
                self.check_refused(((), "/nowhere cannot be run; scripts/setup --preset peers "
                                    f"--target {variable.lower()} builds it"))


if __name__ == "__main__":
    unittest.main()
