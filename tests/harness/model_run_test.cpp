// --model auto through the program: the same velocities, rows that count what was left out, and a directory
// that verifies.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/harness/run_program.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

const Words kPile = {"run", "--scene",         "rock_pile", "--bodies",  "30", "--steps",
                     "60",  "--measure-every", "3",         "--repeats", "1"};

Words with(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

int sum(const CsvTable& table, const std::string& column) {
  int total = 0;
  for (const std::string& cell : table.column(column)) total += std::stoi(cell);
  return total;
}

// The files of a pile's steps, recorded into scratch/recorded.
Words record_pile(const TemporaryDirectory& scratch, const Words& steps) {
  std::string at;
  Words files;
  for (const std::string& step : steps) {
    at += (at.empty() ? "" : ",") + step;
    files.push_back(scratch / ("recorded/rock_pile_step" + std::string(6 - step.size(), '0') + step + ".h5"));
  }
  const ProgramResult recorded = run_cleave(
      {"record", "--scene", "rock_pile", "--bodies", "30", "--at", at, "--out", scratch / "recorded"});
  EXPECT_EQ(recorded.exit_code, 0) << recorded.err;
  return files;
}

TEST(ModelRun, LeavesRowsOutAndChangesNoVelocity) {
  const TemporaryDirectory scratch;
  const fs::path out = scratch / "auto";
  const ProgramResult run =
      run_cleave(with(kPile, {"--solver", "exact,schur,pivot:schur-bodies", "--partitioner", "mix",
                              "--refiner", "fm", "--max-bodies", "8", "--model", "auto", "--out", out}));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const CsvTable rows = read_csv(out / "steps.csv");
  EXPECT_GT(sum(rows, "model_rows_left_out") + sum(rows, "model_rows_at_rest"), 0);
  for (const std::string& spread : rows.column("velocity_spread_m_per_s")) EXPECT_LE(std::stod(spread), 1e-9);
  EXPECT_EQ(rows.column("status"), Words(rows.rows.size(), "ok"));
  EXPECT_EQ(rows.column("model"), Words(rows.rows.size(), "auto"));
  const ProgramResult verified = run_cleave({"verify", out});
  EXPECT_EQ(verified.exit_code, 0) << verified.out;
}

TEST(ModelRun, ReplayTakesItAndRecordsNothing) {
  const TemporaryDirectory scratch;
  const ProgramResult replay =
      run_cleave(with({"replay", "--solver", "exact", "--model", "auto", "--out", scratch / "out"},
                      record_pile(scratch, {"30"})));
  EXPECT_EQ(replay.exit_code, 0) << replay.err;
  EXPECT_EQ(read_csv(scratch / "out/steps.csv").at(0, "model"), "auto");
  EXPECT_EQ(run_cleave({"verify", scratch / "out"}).exit_code, 0);
}

// Of what was left out the file of the problem knows nothing: the interface is that of the rows that were
// solved.
TEST(ModelRun, AReplayWithPartsAndSolutionsVerifies) {
  const TemporaryDirectory scratch;
  const Words options = {"--solver",         "schur,pivot:schur-bodies",
                         "--partitioner",    "mix",
                         "--refiner",        "fm",
                         "--max-bodies",     "8",
                         "--model",          "auto",
                         "--write-solutions"};
  const Words files = record_pile(scratch, {"100", "150", "199"});
  const ProgramResult replayed = run_cleave(with(with({"replay", "--out", scratch / "out"}, options), files));
  ASSERT_EQ(replayed.exit_code, 0) << replayed.err;
  const CsvTable rows = read_csv(scratch / "out/steps.csv");
  EXPECT_GT(sum(rows, "model_rows_left_out") + sum(rows, "model_rows_at_rest"),
            sum(rows, "model_rows_returned"));
  const ProgramResult verified = run_cleave({"verify", scratch / "out"});
  EXPECT_EQ(verified.exit_code, 0) << verified.out;
}

TEST(ModelRun, OdesOwnSolversAreNamed) {
  const TemporaryDirectory scratch;
  const ProgramResult run =
      run_cleave(with(kPile, {"--solver", "ode-step", "--model", "auto", "--out", scratch / "out"}));
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.err.find(
                "--model: auto leaves rows out of the step problem, which --solver ode-step does not read"),
            std::string::npos)
      << run.err;
  EXPECT_FALSE(fs::exists(scratch / "out/steps.csv"));
}

}  // namespace
}  // namespace cleave
