"""What the documents and lists say agrees with the sources."""
import json
import re
import subprocess
import unittest

from synthetic import ROOT, SCRIPTS, command_files, good_row, run_script

from cleave_scripts.results.rows import FAR_NS
from cleave_scripts.results.steps import EXACT_LIMIT

# Where each package is looked for or used, and under which of these names. Any other python3-* package has to
# be imported by a script.
USED_BY = {
    "cmake": ("CMakePresets.json", "configurePresets"),
    "ninja-build": ("CMakePresets.json", "Ninja"),
    "g++": ("CMakeLists.txt", "OpenMP"),
    "pkg-config": ("CMakeLists.txt", "PkgConfig"),
    "git": ("harness/files/build_info.cmake", "git"),
    "libode-dev": ("CMakeLists.txt", "ode"),
    "libeigen3-dev": ("CMakeLists.txt", "Eigen3"),
    "libsuitesparse-dev": ("CMakeLists.txt", "CAMD", "cholmod", "camd", "amd"),
    "libopenblas-dev": ("tests/CMakeLists.txt", "openblas"),
    "libcli11-dev": ("CMakeLists.txt", "CLI11"),
    "libhdf5-dev": ("CMakeLists.txt", "HDF5"),
    "libssl-dev": ("CMakeLists.txt", "OpenSSL"),
    "nlohmann-json3-dev": ("CMakeLists.txt", "nlohmann_json"),
    "libtomlplusplus-dev": ("CMakeLists.txt", "toml++"),
    "libgtest-dev": ("tests/CMakeLists.txt", "GTest"),
    "libbenchmark-dev": ("tests/CMakeLists.txt", "benchmark"),
    "slurm-wlm": ("tests/scripts/slurm_cluster.py", "slurmctld"),
    "munge": ("tests/scripts/slurm_cluster.py", "munged"),
    "libfclib-dev": ("tests/CMakeLists.txt", "fclib"),
    "libmetis-dev": ("CMakeLists.txt", "METIS"),
    "libscotch-dev": ("CMakeLists.txt", "SCOTCH"),
    "libbullet-dev": ("harness/peers/CMakeLists.txt", "BulletDynamics-float64"),
    "libdart-dev": ("harness/peers/CMakeLists.txt", "dart"),
    "libsiconos-numerics-dev": ("harness/peers/CMakeLists.txt", "siconos_numerics"),
    "coinor-libipopt-dev": ("harness/peers/CMakeLists.txt", "ipopt"),
    "libmujoco-dev": ("harness/peers/CMakeLists.txt", "mujoco"),
    "python3": ("tests/CMakeLists.txt", "python3"),
    "chromium": ("tests/scripts/browser.py", "chromium"),
    "clang": ("CMakePresets.json", "clang"),
    "libclang-rt-14-dev": ("CMakePresets.json", "thread"),
    "llvm-14": ("tests/sanitised/sanitised.cmake", "llvm-symbolizer"),
    "libomp-14-dev": ("tests/sanitised/sanitised.cmake", "archer"),
    "qemu-user": ("tests/CMakeLists.txt", "qemu-x86_64"),
    "clang-format": ("tests/scripts/format_test.py", "clang-format"),
    "povray": ("scripts/cleave_scripts/motion/povray_scene.py", "povray"),
    "npm": ("scripts/cleave_scripts/viewer/page.py", "npm"),
}


def package_lists():
    """By preset, "" for what all presets need: lines of [package, reason]."""
    lists = {}
    for file in (SCRIPTS / "data").glob("packages*.txt"):
        lines = [line for line in file.read_text().splitlines() if line and not line.startswith("#")]
        lists[file.stem.removeprefix("packages").removeprefix("_")] = [line.split(maxsplit=1) for line in lines]
    return lists


def packages():
    return {package for lines in package_lists().values() for package, *_ in lines}


def step_record_columns():
    """Columns of steps.csv as harness/experiment/step_record.h lists them and algorithms declare them,
    with one t_s_* a stage and worker count."""
    text = (ROOT / "harness" / "experiment" / "step_record.h").read_text()
    columns = re.findall(r'visit(?:_machine)?\(\s*"(\w+)",', text)
    declared = "".join(file.read_text() for room in ("partition", "solver", "harness") for file in (ROOT / room).rglob("*.cpp"))
    parameters = [name.replace("-", "_") for name in re.findall(r'\.name = "([\w-]+)"', declared)
                  if name != "path"]  # a file's name is in no column
    table = (ROOT / "harness" / "experiment" / "cell_measures.cpp").read_text()
    parameters += re.findall(r'\{"(\w+)",', table)
    clock = (ROOT / "solver" / "stage_times.h").read_text()
    stages = re.findall(r'"(\w+)"', re.search(r"kStageNames = \{(.*?)\}", clock, re.S).group(1))
    workers = re.search(r"kModelWorkers = \{(.*?)\}", clock).group(1).replace(" ", "").split(",")
    return set(columns) | set(parameters) | {f"t_s_{stage}_ms" for stage in stages
                          } | {f"t_s_model_p{count}_ms" for count in workers}


class PackagesTest(unittest.TestCase):

    def test_every_package_is_named_once_with_a_reason(self):
        lists = package_lists()
        for preset, lines in lists.items():
            seen = set() if preset == "" else {package for package, *_ in lists[""]}
            for package, *reason in lines:
                self.assertNotIn(package, seen, preset)
                self.assertGreater(len(" ".join(reason).split()), 1, package)
                seen.add(package)

    def test_every_package_is_used(self):
        for package in packages():
            if package not in USED_BY:
                self.assertIn(package.removeprefix("python3-"), map(str.lower, self.imported_modules()), package)
                continue
            place, *names = USED_BY[package]
            text = (ROOT / place).read_text()
            self.assertTrue(any(re.search(rf"\b{name}\b", text) for name in names),
                            f"{package}: {place} has no {names}")

    def test_only_presets_that_exist_have_packages_of_their_own(self):
        presets = {preset["name"] for preset in json.loads((ROOT / "CMakePresets.json").read_text())["buildPresets"]}
        lists = {file.stem.removeprefix("packages_") for file in (SCRIPTS / "data").glob("packages_*.txt")}
        self.assertLessEqual(lists, presets)

    def test_everything_cmake_looks_for_has_a_package(self):
        text = "".join((ROOT / name).read_text() for name in ("CMakeLists.txt", "tests/CMakeLists.txt"))
        found = re.findall(r"find_package\((?!Python3)(\w+)|IMPORTED_TARGET (\w+)|find_library\(\w+ (\w+)",
                           text)
        known = {name for package in packages() for name in USED_BY.get(package, ())}
        self.assertEqual(set(filter(None, sum(found, ()))) - known, set())

    def test_every_imported_module_has_a_package(self):
        for module in self.imported_modules():
            self.assertIn(f"python3-{module.lower()}", packages())

    def imported_modules(self):
        """Modules that python scripts import and that are neither python's own nor ours."""
        import sys
        files = [
            *(SCRIPTS / "cleave_scripts").rglob("*.py"), *(ROOT / "tests" / "scripts").glob("*.py"),
            *(file for file in command_files() if file.read_text().startswith("#!/usr/bin/python3"))
        ]
        names = set()
        for file in files:
            names |= set(re.findall(r"^\s*(?:import|from) (\w+)", file.read_text(), re.M))
        return names - set(sys.stdlib_module_names) - {file.stem for file in files} - {"cleave_scripts"}


class ColumnsTest(unittest.TestCase):

    def test_results_readme_explains_every_column_and_no_other(self):
        text = (ROOT / "results" / "README.md").read_text()
        rows = [
            line.split("|")[1]
            for line in text[text.index("### The experiment"):].splitlines()
            if line.startswith("| `")
        ]
        self.assertEqual(sorted(name for row in rows for name in re.findall(r"`(\w+)`", row)),
                         sorted(step_record_columns()))

    def test_results_readme_names_the_columns_of_the_machine(self):
        record = (ROOT / "harness" / "experiment" / "step_record.h").read_text()
        marked = set(re.findall(r'visit_machine\(\s*"(\w+)', record))
        text = (ROOT / "results" / "README.md").read_text()
        sentence = re.search(r"are the machine's: (.*?)\.\n", text, re.S).group(1)
        self.assertEqual({name for name in marked if not name.startswith("t_")},
                         set(re.findall(r"`(\w+)`", sentence)) - {"t_"})
        self.assertIn("`t_...`", sentence)
        self.assertTrue({"t_collide_ms", "t_s_", "t_s_model_p", "t_s_waiting_ms"} <= marked)

    def test_cores_are_far_apart_for_scripts_as_for_the_program(self):
        summary = (ROOT / "harness" / "experiment" / "run_summary.h").read_text()
        self.assertEqual(float(re.search(r"kFarNs = (\d+);", summary).group(1)), FAR_NS)
        self.assertIn(f"where it is {FAR_NS} or more", (ROOT / "results" / "README.md").read_text())

    def test_the_judges_limit_is_one_number(self):
        text = (ROOT / "solver" / "step_problem.h").read_text()
        self.assertEqual(float(re.search(r"kExactLimit = (\S+);", text).group(1)), EXACT_LIMIT)

    def test_the_made_up_rows_have_real_columns(self):
        self.assertLessEqual(set(good_row("rock_pile", 0, "mix", "fm")), step_record_columns())


class ScriptsTest(unittest.TestCase):

    def test_every_command_can_be_run_and_explains_itself(self):
        self.assertGreaterEqual(len(command_files()), 6)
        for file in command_files():
            self.assertIn(file.read_text().splitlines()[0], ("#!/bin/bash", "#!/usr/bin/python3"), file)
            result = run_script(file.relative_to(SCRIPTS), "--help")
            self.assertEqual(result.returncode, 0, file)
            self.assertIn("usage: ", result.stdout, file)
            self.assertIn("Exit codes", result.stdout, file)

    def test_bash_scripts_parse_and_are_strict(self):
        for file in [*command_files(), ROOT / ".ci" / "run"]:
            text = file.read_text()
            if text.startswith("#!/bin/bash"):
                self.assertIn("\nset -euo pipefail\n", text, file)
                self.assertEqual(subprocess.run(["bash", "-n", file], check=False).returncode, 0, file)

    def test_links_and_files_the_readmes_name_exist(self):
        for readme in (ROOT / "README.md", ROOT / "results" / "README.md"):
            text = readme.read_text()
            for target in re.findall(r"\]\(([^)#]+)\)", text):
                self.assertTrue((readme.parent / target).exists(), f"{readme}: {target}")
            for target in re.findall(r"`((?:partition|solver|scenarios|harness|scripts)/[\w./]*)`", text):
                self.assertTrue((ROOT / target).exists(), f"{readme}: {target}")


if __name__ == "__main__":
    unittest.main()
