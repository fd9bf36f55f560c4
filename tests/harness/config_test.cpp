// cleave run --config manifest.json repeats a run: the same options, the same run id, the same rows but for
// the machine's columns. record and replay likewise.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "tests/harness/machine_columns.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

using Words = std::vector<std::string>;

Words operator+(Words first, const Words& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

void expect_same_rows(const std::filesystem::path& first, const std::filesystem::path& second) {
  const CsvTable a = read_csv(first / "steps.csv"), b = read_csv(second / "steps.csv");
  ASSERT_EQ(a.header, b.header);
  ASSERT_EQ(a.rows.size(), b.rows.size());
  ASSERT_FALSE(a.rows.empty());
  for (const std::string& column : a.header) {
    if (is_of_the_machine(column)) continue;
    EXPECT_EQ(a.column(column), b.column(column)) << column;
  }
}

class Config : public ::testing::Test {
 protected:
  std::string manifest(const std::string& run) { return directory_ / run / "manifest.json"; }

  // Does the work, repeats it from its manifest, and compares.
  void expect_repeats(const std::string& command, const Words& options) {
    const ProgramResult first = run_cleave(Words{command} + options + Words{"--out", directory_ / "first"});
    ASSERT_NE(first.exit_code, 1) << first.err;
    const ProgramResult again =
        run_cleave({command, "--config", manifest("first"), "--out", directory_ / "again"});
    ASSERT_EQ(again.exit_code, first.exit_code) << again.err;
    expect_same_rows(directory_ / "first", directory_ / "again");
  }

  // A manifest of a short run, in directory_/base, after `change` of its text.
  void make_base(const Words& options = {}) {
    const ProgramResult base = run_cleave(Words{"run", "--out", directory_ / "base"} + kShort + options);
    ASSERT_EQ(base.exit_code, 0) << base.err;
  }

  void replace_in_base(const std::string& text, const std::string& by) {
    std::string json = read_text(manifest("base"));
    const std::size_t at = json.find(text);
    ASSERT_NE(at, std::string::npos) << text;
    std::ofstream(manifest("base")) << json.replace(at, text.size(), by);
  }

  void expect_error(const Words& arguments, const std::string& text) {
    const ProgramResult result = run_cleave(arguments + Words{"--out", directory_ / "none"});
    EXPECT_EQ(result.exit_code, 1) << result.err;
    EXPECT_EQ(count_lines(result.err), 1) << result.err;
    EXPECT_NE(result.err.find(text), std::string::npos) << result.err;
    EXPECT_FALSE(std::filesystem::exists(directory_ / "none"));
  }

  std::string key(const Words& options) {
    const ProgramResult result = run_cleave(Words{"run", "--print-key", "--out", "x"} + options);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.out;
  }

  inline static const Words kShort = {
      "--scene", "rock_pile",     "--bodies", "4",         "--steps", "30",        "--measure-every",
      "30",      "--partitioner", "mix",      "--refiner", "none",    "--repeats", "1"};
  TemporaryDirectory directory_;
};

TEST_F(Config, RepeatsSettingsOfOneAlgorithmAndStiffnessWithDamping) {
  expect_repeats("run", {"--scene",
                         "rock_pile",
                         "--bodies",
                         "20",
                         "--steps",
                         "60",
                         "--measure-every",
                         "30",
                         "--partitioner",
                         "mindp@max-bodies=9,mix",
                         "--refiner",
                         "none,fm",
                         "--solver",
                         "pgs@sweeps=30,schur",
                         "--stiffness",
                         "12345.678",
                         "--damping",
                         "0.1",
                         "--dt",
                         "0.0123",
                         "--tau-mix",
                         "0.3",
                         "--repeats",
                         "1",
                         "--seed",
                         "18446744073709551615"});
}

TEST_F(Config, RepeatsConstantFrictionAndTheScenesOptions) {
  expect_repeats("run", {"--scene",
                         "rock_pile",
                         "--bodies",
                         "7",
                         "--rock-shape",
                         "convex",
                         "--steps",
                         "40",
                         "--measure-every",
                         "20",
                         "--friction",
                         "constant",
                         "--friction-force-n",
                         "2.5",
                         "--erp",
                         "0.35",
                         "--cfm",
                         "1e-7",
                         "--gravity",
                         "3.7",
                         "--advance",
                         "monolithic",
                         "--skip",
                         "20",
                         "--repeats",
                         "1"});
}

TEST_F(Config, RepeatsConvergedFrictionAndAnOverriddenStrategy) {
  expect_repeats("run",
                 {"--scene",      "chain_drop", "--steps",       "20",           "--measure-every",
                  "10",           "--friction", "box-converged", "--mu",         "0.8",
                  "--strategy",   "newton",     "--kernel",      "schur-bodies", "--skip-small-islands",
                  "--max-bodies", "6",          "--as-printed",  "--repeats",    "1",
                  "--threads",    "2"});
}

TEST_F(Config, RepeatsAWorldPerCombination) {
  expect_repeats("run", {"--scene", "rock_pile", "--bodies", "6", "--steps", "20", "--measure-every", "10",
                         "--mode", "separate", "--partitioner", "mix,bfs", "--refiner", "kl", "--solver",
                         "schur,ode-quickstep@quickstep-iterations=7", "--repeats", "1"});
}

TEST_F(Config, RepeatsRecordAndReplay) {
  const Words scene = {"--scene", "rock_pile", "--bodies", "8", "--erp", "0.3"};
  expect_repeats("record",
                 scene + Words{"--at", "20,40", "--advance", "schur", "--partitioner", "bfs@max-bodies=3"});
  for (const char* file : {"rock_pile_step000020.h5", "rock_pile_step000040.h5"})
    EXPECT_EQ(read_text(directory_ / "first" / file), read_text(directory_ / "again" / file)) << file;

  const std::string spaced = directory_ / "a b.h5";
  std::filesystem::copy_file(directory_ / "first/rock_pile_step000020.h5", spaced);
  const ProgramResult first =
      run_cleave({"replay", spaced, directory_ / "first/rock_pile_step000040.h5", "--cold", "--solver",
                  "schur", "--max-bodies", "3", "--partitioner", "mix", "--out", directory_ / "replayed"});
  ASSERT_EQ(first.exit_code, 0) << first.err;
  const ProgramResult again =
      run_cleave({"replay", "--config", manifest("replayed"), "--out", directory_ / "replayed again"});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  expect_same_rows(directory_ / "replayed", directory_ / "replayed again");
  EXPECT_EQ(read_csv(directory_ / "replayed again/steps.csv").column("cold").front(), "1");
}

TEST_F(Config, RepeatsARecordOfASolverWithoutParts) {
  expect_repeats("record", {"--scene", "rock_pile", "--bodies", "4", "--at", "10"});
}

// What is given now wins, and what it replaces goes.
TEST_F(Config, OptionsBesideItWin) {
  make_base({"--stiffness", "5000", "--damping", "10", "--strategy", "newton"});
  const Words base = kShort + Words{"--stiffness", "5000", "--damping", "10", "--strategy", "newton"};
  const Words config = {"--config", manifest("base")};
  EXPECT_EQ(key(config), key(base));
  EXPECT_EQ(key(config + Words{"--seed", "60"}), key(base + Words{"--seed", "60"}));
  EXPECT_NE(key(config + Words{"--seed", "60"}), key(base));
  EXPECT_EQ(key(config + Words{"--stiffness", "6000"}),
            key(kShort + Words{"--stiffness", "6000", "--damping", "10", "--strategy", "newton"}));
  // erp of k = 5000, d = 10 stays when cfm is given.
  const std::string erp = read_csv(directory_ / "base/steps.csv").at(0, "erp");
  EXPECT_EQ(key(config + Words{"--cfm", "1e-4"}),
            key(kShort + Words{"--erp", erp, "--cfm", "1e-4", "--strategy", "newton"}));
  EXPECT_EQ(key(config + Words{"--solver", "monolithic"}),
            key(kShort + Words{"--stiffness", "5000", "--damping", "10", "--solver", "monolithic"}));
  EXPECT_EQ(key(config + Words{"--friction", "none"}), key(base + Words{"--friction", "none"}));
  EXPECT_EQ(key(config + Words{"--mode", "separate"}), key(base + Words{"--mode", "separate"}));
  // Another scene has options of its own: --bodies of the pile is not handed on.
  const Words tower = {"--scene",       "log_tower", "--steps",   "30",   "--measure-every", "30",
                       "--partitioner", "mix",       "--refiner", "none", "--repeats",       "1"};
  EXPECT_EQ(key(config + Words{"--scene", "log_tower"}),
            key(tower + Words{"--stiffness", "5000", "--damping", "10", "--strategy", "newton"}));
}

TEST_F(Config, ASessionBesideItTakesNoRepeatsFromIt) {
  make_base();
  replace_in_base("\"repeats\": 1", "\"repeats\": 3");
  EXPECT_EQ(key(Words{"--config", manifest("base"), "--session"}), key(kShort + Words{"--session"}));
}

TEST_F(Config, PartitionersBesideItAreThoseNamed) {
  make_base({"--objective", "cost"});
  Words named = kShort;
  *std::next(std::ranges::find(named, "--partitioner")) = "multilevel";
  EXPECT_EQ(key({"--config", manifest("base"), "--partitioner", "multilevel"}), key(named));
}

TEST_F(Config, ABodyOrderInAFileIsGivenBesideIt) {
  const std::filesystem::path order = directory_ / "order.txt";
  std::ofstream(order) << "3\n2\n1\n0\n";
  const Arguments words = {"--scene",      "rock_pile",
                           "--bodies",     "4",
                           "--steps",      "2",
                           "--body-order", "file@" + order.string(),
                           "--out",        directory_ / "base"};
  const ProgramResult base = run_cleave(Arguments{"run"} + words);
  ASSERT_EQ(base.exit_code, 0) << base.err;
  expect_error({"run", "--config", manifest("base")},
               "is known by its content, not by its file; give --body-order");
}

// Rows name such a scene by its content; where it lies has to be said again.
TEST_F(Config, ASceneInAFileIsGivenBesideIt) {
  const std::string file = std::string("file@path=") + CLEAVE_SOURCE_DIR + "/scenarios/files/pile.toml";
  const ProgramResult base = run_cleave({"run", "--scene", file, "--steps", "2", "--refiner", "none", "--mu",
                                         "0.25", "--out", directory_ / "base"});
  ASSERT_EQ(base.exit_code, 0) << base.err;
  expect_error({"run", "--config", manifest("base")},
               "is known by its content, not by its file; give --scene");
  const ProgramResult again =
      run_cleave({"run", "--config", manifest("base"), "--scene", file, "--out", directory_ / "again"});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  expect_same_rows(directory_ / "base", directory_ / "again");
}

TEST_F(Config, OutAndForceAreNotTaken) {
  make_base({"--force"});
  const ProgramResult result = run_cleave({"run", "--config", manifest("base")});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err.find("cleave run: --out: is required"), 0u) << result.err;
  const ProgramResult onto = run_cleave({"run", "--config", manifest("base"), "--out", directory_ / "base"});
  EXPECT_EQ(onto.exit_code, 1);
  EXPECT_NE(onto.err.find("--force"), std::string::npos) << onto.err;
}

TEST_F(Config, AManifestThatCannotBeRepeatedIsOneLine) {
  const Words run = {"run", "--config", manifest("base")};
  expect_error(run, "base/manifest.json: cannot be read");
  make_base();
  expect_error({"record", "--config", manifest("base")}, "command is 'run', allowed: record");
  expect_error({"replay", "--config", manifest("base")}, "command is 'run', allowed: replay");
  replace_in_base("\"mu\": 0.5", "\"mi\": 0.5");
  expect_error(run, "option 'mi' is unknown (did you mean 'mu'?)");
  replace_in_base("\"mi\": 0.5", "\"mu\": -1");
  expect_error(run, "--mu: -1 is not in [0, inf)");
  replace_in_base("\"mu\": -1", "\"mu\": {\"of\": 1}");
  expect_error(run, "option mu: allowed are text, number");
  replace_in_base("\"mu\": {\"of\": 1}", "\"mu\": [1]");
  expect_error(run, "option mu: allowed are text, number");
  replace_in_base("\"mu\": [1]", "\"mu\": ");
  expect_error(run, "is not JSON from byte ");
  std::ofstream(manifest("base")) << R"({"schema": 1e400})";
  expect_error(run, "base/manifest.json: holds a number beyond the range of 64-bit floats");
  std::ofstream(manifest("base")) << "[1, 2]";
  expect_error(run, "holds no JSON object");
  std::ofstream(manifest("base")) << R"({"schema": "cleave-run-9", "command": "run", "options": {}})";
  expect_error(run, "schema is 'cleave-run-9', allowed: cleave-run-1");
  std::ofstream(manifest("base")) << R"({"schema": "cleave-run-1", "command": "run", "options": 3})";
  expect_error(run, "options are missing");
  std::ofstream(manifest("base")) << R"({"command": "run", "options": {}})";
  expect_error(run, "schema is missing, allowed: cleave-run-1");
  std::ofstream(manifest("base")) << "";
  expect_error(run, "is not JSON from byte ");
  expect_error({"run", "--config", directory_.path()}, "cannot be read");
}

}  // namespace
}  // namespace cleave
