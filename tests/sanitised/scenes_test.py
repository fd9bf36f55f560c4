"""Short runs of every scene, with every partitioner, refiner and solver, on two threads, in a build with sanitisers."""
import csv
import os
import pathlib
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
CLEAVE = pathlib.Path(os.environ["CLEAVE_BINARY_DIR"]) / "cleave"

# Steps until bodies lie on each other, and sizes with several parts.
RUNS = {
    "chain_drop": (60, "--links", "30"),
    "log_tower": (70, "--layers", "4", "--logs", "3"),
    "rock_pile": (80, "--bodies", "30"),
    "large_rock_pile": (80, "--bodies", "40", "--rock-shape", "convex"),
    "silo": (10, "--bodies", "20"),
    "crane": (10, "--links", "20", "--dt", "0.001", "--cfm", "1e-10"),
    "mixed_site": (40, "--links", "50", "--rings", "1", "--dt", "0.001", "--cfm", "1e-10"),
    "ladder_stack": (10, "--copies", "2"),
    "ladder_heavy_top": (10,),
    "ladder_alternating": (10,),
    "ladder_incline": (10, "--boxes", "6"),
    "ladder_chain": (10,),
    "ladder_loop": (10, "--links", "12"),
    "ladder_free": (10, "--boxes", "6"),
}
PILE = ROOT / "scenarios" / "files" / "pile.toml"
FROM_FILE = f"file@path={PILE}"
WITH_GROUPS = {"crane", "mixed_site", FROM_FILE}  # scenes that name the groups semantic splits by


def cleave(*arguments):
    return subprocess.run([CLEAVE, *map(str, arguments)], capture_output=True, text=True, check=False)


def names(what):
    return cleave("list", what, "--names").stdout.split()


class ScenesTest(unittest.TestCase):

    def rows_of(self, scene, *options, steps):
        """Two measured steps on two threads, both of which have something to do."""
        with tempfile.TemporaryDirectory() as directory:
            done = cleave("run", "--scene", scene, *options, "--max-bodies", 3, "--repeats", 1, "--threads", 2,
                          "--steps", steps, "--measure-every", steps // 2, "--out", f"{directory}/out")
            self.assertIn(done.returncode, (0, 2), done.stderr[-4000:])  # 2: not every solver is exact
            with open(f"{directory}/out/steps.csv", newline="", encoding="utf-8") as file:
                rows = list(csv.DictReader(file))
        self.assertGreater(max(int(row["parts"]) for row in rows), 1)
        self.assertEqual(len({row["step"] for row in rows}), 2)
        return rows

    def run_scene(self, scene, *size, steps):
        """Every combination by one solver, then every solver with a few of them."""
        rows = self.rows_of(scene, *size, "--partitioner", "all", "--trials", 10, "--refiner", "all", "--solver", "schur",
                            steps=steps)
        left_out = {"file"} if scene in WITH_GROUPS else {"file", "semantic"}
        self.assertEqual({(row["partitioner"], row["refiner"]) for row in rows},
                         {(partitioner, refiner) for refiner in names("refiners")
                          for partitioner in set(names("partitioners")) - left_out})
        solvers = names("solvers") + [f"{strategy}:{kernel}" for strategy in ("pivot", "interior-point")
                                      for kernel in ("schur-rows", "schur-bodies", "schur-nested")]
        rows = self.rows_of(scene, *size, "--partitioner", "mindp,multilevel", "--refiner", "none,fm",
                            "--solver", ",".join(solvers), steps=steps)
        self.assertEqual({row["solver"] for row in rows}, set(solvers))

    def test_every_scene_has_a_run(self):
        self.assertEqual(set(names("scenes")), {"file", *RUNS})

    def test_every_scene_runs(self):
        for scene, (steps, *size) in RUNS.items():
            with self.subTest(scene):
                self.run_scene(scene, *size, steps=steps)

    def test_a_scene_of_a_file_runs(self):
        self.run_scene(FROM_FILE, steps=20)


if __name__ == "__main__":
    unittest.main()
