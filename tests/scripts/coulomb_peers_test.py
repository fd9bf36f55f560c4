"""scripts/coulomb_peers: what is made of its rows, and the command with a stand-in for both programs."""
import csv
import os
import pathlib
import unittest
import unittest.mock

import stored_data
from stand_in import NOTES_ITS_CALL, StandInCase

from cleave_scripts.documents import friction
from cleave_scripts.documents.stored import Stored
from cleave_scripts.measurements.coulomb_beside_siconos import (CFMS, COLUMNS, MUS, STEPS, THEIRS, beyond, beyond_table,
                                                                counts, scene_table)

STAND_IN = NOTES_ITS_CALL + """import coulomb_peers_test
sys.exit(coulomb_peers_test.answer(words, given))
"""
ERRORS = {"exact": 1e-12, THEIRS[0]: 1e-6, THEIRS[1]: 1e-11}


def answer(words, given):
    """As the programs do: Gauss-Seidel does not end, the first step has no contacts, the second times out in Newton."""
    from synthetic import touch_recorded, write_steps
    if words[0] == "siconos-error":
        print("file,solver,rows,residual_m_per_s,siconos_error,velocity_difference_m_per_s")
        for solver, error in ERRORS.items():
            if solver == os.environ.get("STAND_IN_NOT_STORED"):
                continue
            if not (solver == THEIRS[1] and "step000200" in words[1] and "silo" in words[1]):
                print(f"{words[1]},{solver},12,{error},{error},{error}")
        return 0
    if words[0] == "record":
        touch_recorded(given)
        return 2
    files = [pathlib.Path(word) for word in words if word.endswith(".h5")]
    write_steps(given["--out"], [dict(scene=file.name.partition("_step")[0], step=int(file.stem[-6:]), bodies=2, rows=12,
                                      rows_bilateral=0, solver=solver, contacts=0 if "silo_step000060" in file.name else 4,
                                      iterations=7, residual_m_per_s=1e-12, status="ok")
                                 for file in files for solver in given["--solver"].split(",")])
    return 2


def row(**given):
    """One that both solved."""
    return dict(scene="silo", bodies=2, step=60, cfm="1e-5", mu="0.5", contacts=4, rows=12, rows_bilateral=0, status="ok",
                residual_m_per_s=1e-15, siconos_error=1e-14, peer="siconos-newton", peer_status="ok", peer_iterations=7,
                peer_residual_m_per_s=1e-12, peer_siconos_error=1e-11, velocity_difference_m_per_s=1e-9) | given


class LimitsTest(unittest.TestCase):

    def test_every_limit_is_named_where_it_is_passed_and_only_of_what_was_solved(self):
        for given, words in (({}, []), ({"siconos_error": 2e-8}, ["our error"]),
                             ({"peer_residual_m_per_s": 2e-6}, ["their residual"]),
                             ({"velocity_difference_m_per_s": 2e-6}, ["velocities"]),
                             ({"status": "not_converged", "siconos_error": 1, "velocity_difference_m_per_s": 1},
                              ["not solved by us"]),
                             ({"peer_siconos_error": 2e-10, "peer_residual_m_per_s": 1, "velocity_difference_m_per_s": 1},
                              ["not solved by them"]),
                             ({"peer_siconos_error": "nan"}, ["not solved by them"])):
            with self.subTest(given):
                self.assertEqual(list(beyond(row(**given))), words)

    def test_counts_are_of_problems_and_of_pairs(self):
        rows = [row(), row(peer="siconos-nsgs", peer_siconos_error=1e-3),
                row(step=200, status="not_converged", siconos_error=1e-5), row(mu="0.3", peer_siconos_error="nan"),
                row(mu="0.8", velocity_difference_m_per_s=0.5, peer_residual_m_per_s=1e-3), row(mu="0.8", peer="siconos-nsgs")]
        told = counts(rows)
        for words in ("4 problems. Solved by us: 3; of these Siconos's error is at most 1e-8 on 3 of 3, of all on 3 of 4.",
                      "1e-10 4 of 6 times; of these our residual is at most 1e-6 m/s on 3 of 4.",
                      "on 1 of 1 with mu <= 0.5 and on 1 of 2 with a larger one", "not by us: 1 problems; by us alone: 1."):
            self.assertIn(words, told)
        self.assertIn("| silo | 1e-5 | 4 to 4 | 3 of 4 | 1.0e-14 | 1 of 4 | 3 of 4 | 0.00100 | 3 | 1.0e-9 | 0.500 |",
                      scene_table(rows))
        listed = beyond_table(rows).splitlines()[2:]
        self.assertEqual(len(listed), 4)
        self.assertEqual(listed[1], "| silo | 200 | 1e-5 | 0.5 | siconos-newton | not solved by us | 1.0e-15 | 1.0e-5 | "
                         "1.0e-12 | 1.0e-11 | 1.0e-9 |")


class CoulombPeersTest(StandInCase):
    stand_in, script = STAND_IN, "coulomb_peers"

    def setUp(self):
        super().setUp()
        self.enterContext(unittest.mock.patch.dict(os.environ, CLEAVE_PEERS=str(self.program)))

    def rows(self):
        with open(self.directory / "out" / "coulomb_peers.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(tuple(rows[0]), COLUMNS)
        return rows

    def test_every_step_with_contacts_by_every_solver(self):
        said = self.run_it("--scene", "silo,chain_drop").stdout
        calls = self.calls()
        settings = len(CFMS) * len(MUS)
        self.assertEqual([sum(call.startswith(word) for call in calls) for word in ("record", "replay", "siconos-error")],
                         [2 * settings, 2 * settings, 3 * settings])
        self.assertIn(f"record --scene silo --at {STEPS[0]},{STEPS[1]} --bodies 27 --friction coulomb --advance exact "
                      "--cfm 1e-5 --mu 0.3 ", calls[0])
        self.assertIn(f"--solver exact,{','.join(THEIRS)} --repeats 1 --peer-tolerance 1e-10 --write-solutions", calls[1])
        rows = self.rows()
        self.assertEqual(len(rows), 3 * settings * len(THEIRS))
        self.assertEqual([rows[0][name] for name in ("step", "mu", "cfm", "peer", "siconos_error", "peer_siconos_error")],
                         ["200", "0.3", "1e-5", "siconos-nsgs", "1e-12", "1e-06"])
        self.assertEqual((rows[1]["peer"], rows[1]["peer_siconos_error"], rows[-1]["peer_siconos_error"]),
                         ("siconos-newton", "nan", "1e-11"))
        self.assertIn("| chain drop | 1e-9 | 4 to 4 | 6 of 6 | 1.0e-12 | 0 of 6 | 6 of 6 |", said)
        self.assertIn(f"by us alone: {settings}.", said)

    def test_the_document_tells_them(self):
        self.run_it("--scene", "silo")
        stored_data.write_provenance(self.directory / "out", "coulomb_peers.csv")
        told = friction.coulomb_peers(Stored(self.directory / "out"))
        self.assertIn("Some CPU, 2 cores", told)
        self.assertIn("| silo | 1e-5 | 4 to 4 | 3 of 3 |", told)
        told = friction.coulomb_beyond(Stored(self.directory / "out"))
        self.assertIn("18 of 18 rows, a row a problem and solver of Siconos (`scripts/coulomb_peers`; Some CPU, 2 cores", told)
        self.assertIn("Left out are `crane` and `mixed_site`: their motors are refused.", told)
        self.assertIn("| silo | 200 | 1e-9 | 0.8 | siconos-newton | not solved by them | ", told)

    def test_a_step_of_which_we_stored_no_solution_is_a_row(self):
        with unittest.mock.patch.dict(os.environ, STAND_IN_NOT_STORED="exact"):
            self.run_it("--scene", "chain_drop")
        self.assertEqual({(row["siconos_error"], row["velocity_difference_m_per_s"]) for row in self.rows()}, {("nan", "nan")})
        self.assertEqual({row["peer_siconos_error"] for row in self.rows()}, {"1e-06", "1e-11"})

    def test_a_bad_option_or_a_program_that_is_not_there_is_one_line(self):
        self.check_refused((("--scene", "crane"), "--scene has 'crane'"))
        with unittest.mock.patch.dict(os.environ, CLEAVE_PEERS="/nowhere"):
            self.check_refused(((), "/nowhere cannot be run; scripts/setup --preset peers --target cleave_peers builds it"))


if __name__ == "__main__":
    unittest.main()
