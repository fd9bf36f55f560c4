"""scripts/setup, scripts/test and .ci/run against stand-ins for apt-get, cmake and ctest."""
import pathlib
import shutil
import subprocess
import tempfile
import unittest

from synthetic import ROOT, SCRIPTS

TOOLS = ("awk", "basename", "bash", "cat", "dirname", "env", "grep", "mktemp", "rm", "sed", "sort", "tee",
         "tr", "nproc")
DPKG_QUERY = """#!/bin/bash
sed 's/.*/installed &, /' "$FAKE/installed"
echo "config-files removed, cmake"
"""
LOGGER = """#!/bin/bash
echo "$(basename "$0") $*" >>"$FAKE/log"
[[ ! -e $FAKE/fail_$1 ]]
"""


class StandInTest(unittest.TestCase):
    """A PATH that holds nothing but a few ordinary tools and stand-ins."""

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.directory = pathlib.Path(scratch.name)
        self.bin = self.directory / "bin"
        self.bin.mkdir()
        for tool in TOOLS:
            (self.bin / tool).symlink_to(shutil.which(tool))
        self.stand_in("id", "#!/bin/bash\necho ${FAKE_ID:-0}\n")
        (self.directory / "log").touch()

    def stand_in(self, name, text=LOGGER):
        (self.bin / name).write_text(text)
        (self.bin / name).chmod(0o755)

    def run_program(self, *arguments, **variables):
        environment = {"PATH": str(self.bin), "FAKE": str(self.directory), **variables}
        return subprocess.run([str(argument) for argument in arguments],
                              capture_output=True,
                              text=True,
                              timeout=60,
                              check=False,
                              env=environment,
                              cwd="/")

    def log(self):
        return (self.directory / "log").read_text().splitlines()


class SetupTest(StandInTest):

    def setUp(self):
        super().setUp()
        self.stand_in("dpkg-query", DPKG_QUERY)
        self.stand_in("apt-get")
        self.stand_in("cmake")
        self.packages = [
            line.split()[0]
            for line in (SCRIPTS / "data" / "packages.txt").read_text().splitlines()
            if not line.startswith("#")
        ]
        self.install(self.packages)

    def install(self, packages):
        (self.directory / "installed").write_text("".join(f"{name}\n" for name in packages))

    def setup_script(self, *arguments, **variables):
        return self.run_program(SCRIPTS / "setup", *arguments, **variables)

    def test_apt_get_is_not_touched_when_everything_is_there(self):
        result = self.setup_script()
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.log(), ["cmake --preset release", "cmake --build --preset release"])

    def test_targets_are_all_that_is_built(self):
        self.assertEqual(self.setup_script("--target", "cleave", "--target", "solver_benchmark").returncode, 0)
        self.assertEqual(self.log()[-1], "cmake --build --preset release --target cleave --target solver_benchmark")
        self.assertIn("--target needs a name", self.setup_script("--target").stderr)

    def test_only_what_is_missing_is_installed_after_one_update(self):
        self.install([name for name in self.packages if name not in ("cmake", "libode-dev")])
        self.assertEqual(self.setup_script("--preset", "asan").returncode, 0)
        update, install, *build = self.log()
        self.assertEqual(update.split()[:2], ["apt-get", "update"])
        self.assertEqual(install.split()[1], "install")
        self.assertEqual([word for word in install.split()[2:] if word[0] != "-"], ["cmake", "libode-dev"])
        self.assertEqual(build, ["cmake --preset asan", "cmake --build --preset asan"])

    def test_packages_of_one_preset_are_installed_for_it_alone(self):
        for preset in ("release", "asan"):
            self.assertEqual(self.setup_script("--preset", preset).returncode, 0)
        self.assertFalse([line for line in self.log() if line.startswith("apt-get")])
        for preset in ("tsan", "fuzz", "peers"):
            self.assertEqual(self.setup_script("--preset", preset).returncode, 0)
        installs = [line for line in self.log() if " install " in line]
        clang = ["clang", "libclang-rt-14-dev", "llvm-14", "libomp-14-dev"]
        peers = ["libbullet-dev", "libdart-dev", "libsiconos-numerics-dev", "coinor-libipopt-dev", "libmujoco-dev"]
        self.assertEqual([[word for word in install.split()[2:] if word[0] != "-"] for install in installs],
                         [clang, clang, peers])

    def test_what_another_package_provides_is_there(self):
        self.install([name for name in self.packages if name not in ("npm", "cmake")] + ["node, npm, cmake (= 3)"])
        self.assertEqual(self.setup_script().returncode, 0)
        self.assertEqual(self.log(), ["cmake --preset release", "cmake --build --preset release"])

    def test_sudo_is_used_by_others_than_root(self):
        self.install([])
        self.stand_in("sudo", '#!/bin/bash\necho "sudo $*" >>"$FAKE/log"\n')
        self.assertEqual(self.setup_script(FAKE_ID="1000").returncode, 0)
        self.assertTrue(all(line.startswith("sudo ") for line in self.log()[:2]), self.log())

    def test_neither_root_nor_sudo(self):
        self.install(self.packages[1:])
        result = self.setup_script(FAKE_ID="1000")
        self.assertEqual((result.returncode, self.log()), (1, []))
        self.assertEqual(len(result.stderr.splitlines()), 1)
        self.assertIn(f"apt-get install {self.packages[0]}", result.stderr)

    def test_no_debian(self):
        (self.bin / "apt-get").unlink()
        result = self.setup_script()
        self.assertEqual((result.returncode, self.log()), (1, []))
        self.assertIn("no Debian", result.stderr)

    def test_every_failure_stops_with_a_message(self):
        self.install([])
        for call, words in (("update", "apt-get update failed"), ("install", "apt-get install failed"),
                            ("--preset", "cmake --preset release failed"), ("--build", "the build")):
            with self.subTest(call):
                (self.directory / f"fail_{call}").touch()
                result = self.setup_script()
                (self.directory / f"fail_{call}").unlink()
                self.assertEqual(result.returncode, 1)
                self.assertIn(words, result.stderr.splitlines()[-1])

    def test_wrong_options(self):
        for arguments in (["--unknown"], ["--preset"]):
            self.assertEqual(self.setup_script(*arguments).returncode, 1)
        self.assertEqual(self.log(), [])


class TestScriptTest(StandInTest):
    """scripts/test and .ci/run in a tree whose setup does nothing and whose ctest prints a given text."""

    def setUp(self):
        super().setUp()
        self.root = self.directory / "tree"
        for name in ("scripts/test", ".ci/run"):
            (self.root / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, self.root / name)
        (self.root / "scripts" / "setup").write_text(LOGGER)
        (self.root / "scripts" / "setup").chmod(0o755)
        self.ctest()

    def ctest(
            self,
            output="1/1 Test #1: a ...   Passed   0.01 sec\n100% tests passed, 0 tests failed out of 1\n",
            full_log="",
            code=0,
            fails="/build/"):
        for preset in ("release", "asan", "tsan"):
            log = self.root / "build" / preset / "Testing" / "Temporary" / "LastTest.log"
            log.parent.mkdir(parents=True, exist_ok=True)
            log.write_text(full_log)
        (self.directory / "output").write_text(output)
        self.stand_in("ctest", f'#!/bin/bash\necho "ctest $*" >>"$FAKE/log"\ncat "$FAKE/output"\n'
                      f'[[ "$*" == *{fails}* ]] || exit 0\nexit {code}\n')

    def test_sets_up_runs_and_ends_with_ctests_verdict(self):
        result = self.run_program(self.root / "scripts" / "test", "-R", "partition")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.log()[0], "setup --preset release")
        self.assertRegex(self.log()[1], r"^ctest --test-dir .*/build/release .*-R partition$")
        self.assertEqual(result.stdout.splitlines()[-1], "100% tests passed, 0 tests failed out of 1")

    def test_preset(self):
        self.assertEqual(self.run_program(self.root / "scripts" / "test", "--preset", "tsan").returncode, 0)
        self.assertIn("/build/tsan ", self.log()[1])

    def test_exit_code_of_ctest_and_of_setup(self):
        self.ctest("0% tests passed, 1 tests failed out of 1\n", code=8)
        result = self.run_program(self.root / "scripts" / "test")
        self.assertEqual((result.returncode, result.stdout.splitlines()[-1]),
                         (8, "0% tests passed, 1 tests failed out of 1"))
        (self.directory / "fail_--preset").touch()
        (self.directory / "log").write_text("")
        self.assertEqual(self.run_program(self.root / "scripts" / "test").returncode, 1)
        self.assertEqual(self.log(), ["setup --preset release"])

    def test_a_skipped_test_fails_in_ci_only(self):
        passed = "100% tests passed, 0 tests failed out of 2\n"
        for output, full_log in (("1/2 Test #1: a ...***Skipped   0.01 sec\n" + passed, ""),
                                 ("2/2 Test #2: scripts ...   Passed\n" + passed, "OK (skipped=1)\n"),
                                 ("2/2 Test #2: solver/1_of_12 ...   Passed\n" + passed, "[  SKIPPED ] A.Test (0 ms)\n")):
            self.ctest(output, full_log)
            self.assertEqual(self.run_program(self.root / "scripts" / "test").returncode, 0)
            for command, variables in (("scripts/test", {"CI": "true"}), (".ci/run", {})):
                result = self.run_program(self.root / command, **variables)
                self.assertEqual(result.returncode, 1)
                self.assertIn("not every test ran", result.stdout)

    def test_ci_run_passes_when_everything_does(self):
        self.assertEqual(self.run_program(self.root / ".ci" / "run").returncode, 0)
        self.assertEqual([line for line in self.log() if line.startswith("setup")],
                         ["setup --preset release", "setup --preset asan"])

    def test_either_preset_fails_ci_run(self):
        for preset in ("release", "asan"):
            with self.subTest(preset):
                (self.directory / "log").write_text("")
                self.ctest("0% tests passed, 1 tests failed out of 1\n", code=8, fails=f"/build/{preset}")
                self.assertEqual(self.run_program(self.root / ".ci" / "run").returncode, 8)
                self.assertEqual(len(self.log()), 4)  # the other one ran too


if __name__ == "__main__":
    unittest.main()
