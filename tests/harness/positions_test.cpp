// Partitioners that go by the positions of bodies: from a world, from its problem files, and from files that
// tell none.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "harness/experiment/algorithms.h"
#include "harness/files/problem_file.h"
#include "partition/registry.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;
const Arguments kSplit = {"--partitioner", "geometric,random,karger,single",
                          "--refiner",     "none,fm",
                          "--max-bodies",  "6",
                          "--repeats",     "1"};

class Positions : public testing::Test {
 protected:
  void SetUp() override {
    const ProgramResult result = run_cleave(
        {"record", "--scene", "rock_pile", "--bodies", "30", "--at", "80", "--out", *this / "made"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }
  fs::path operator/(const std::string& name) const { return directory_ / name; }
  std::string problem() const { return *this / "made" / "rock_pile_step000080.h5"; }
  ProgramResult replay(const std::string& file, const std::string& out, const Arguments& more) const {
    return run_cleave(Arguments{"replay", file, "--write-solutions", "--out", *this / out} + more);
  }
  // The problem, but all bodies are at one place: what it means to leave positions out.
  std::string problem_without_positions() const {
    ProblemFile file = read_problem_file(problem());
    std::ranges::fill(file.position, 0.0);
    write_problem_file(*this / "nowhere.h5", file);
    return *this / "nowhere.h5";
  }

  TemporaryDirectory directory_;
};

TEST_F(Positions, AWorldAndItsProblemFileSplitAlike) {
  const ProgramResult run = run_cleave(Arguments{"run", "--scene", "rock_pile", "--bodies", "30", "--steps",
                                                 "81", "--measure-every", "81", "--out", *this / "run"} +
                                       kSplit);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const ProgramResult replayed = replay(problem(), "replayed", kSplit);
  ASSERT_EQ(replayed.exit_code, 0) << replayed.err;
  const CsvTable live = read_csv(*this / "run/steps.csv"), again = read_csv(*this / "replayed/steps.csv");
  ASSERT_EQ(live.rows.size(), 8u);
  for (const char* column :
       {"step", "partitioner", "parts", "interface_rows_before", "interface_rows", "solution_hash"})
    EXPECT_EQ(live.column(column), again.column(column)) << column;
  EXPECT_EQ(again.at(0, "partitioner"), "geometric");
  EXPECT_EQ(again.at(0, "parts"), "5");
  EXPECT_EQ(again.at(0, "partition_seed"), "-");
  EXPECT_EQ(again.at(2, "partition_seed"), "1");
  EXPECT_EQ(again.at(4, "karger_method"), "contract");
  EXPECT_EQ(again.at(6, "parts"), "1");
}

TEST_F(Positions, VerifySplitsThemAgain) {
  const ProgramResult replayed = replay(problem(), "out",
                                        {"--partitioner", "geometric,random", "--max-bodies", "6", "--solver",
                                         "schur,pivot:schur-nested", "--repeats", "1"});
  ASSERT_EQ(replayed.exit_code, 0) << replayed.err;
  EXPECT_EQ(replay(problem(), "karger",
                   {"--partitioner", "karger@trials=3@karger-method=recursive-bisection,single",
                    "--max-bodies", "6"})
                .exit_code,
            0);
  for (const char* out : {"out", "karger"}) {
    const ProgramResult result = run_cleave({"verify", *this / out});
    EXPECT_EQ(result.exit_code, 0) << result.out;
  }
}

TEST_F(Positions, AreKnownUnlessAllAreZero) {
  const ProblemFile file = read_problem_file(problem());
  EXPECT_EQ(known_positions(file), file.position);
  EXPECT_TRUE(known_positions(read_problem_file(problem_without_positions())).empty());
}

TEST_F(Positions, AFileWithoutThemIsARefusedRow) {
  const ProgramResult result = replay(problem_without_positions(), "out", kSplit);
  EXPECT_EQ(result.exit_code, 2) << result.err;
  const CsvTable table = read_csv(*this / "out/steps.csv");
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const bool is_refused = table.at(row, "partitioner") == "geometric";
    EXPECT_EQ(table.at(row, "status"), is_refused ? "refused" : "ok");
    if (is_refused) {
      EXPECT_EQ(table.at(row, "status_reason"),
                "geometric: the positions of the bodies are not known, which it splits by");
    }
  }
  EXPECT_EQ(run_cleave({"verify", *this / "out"}).exit_code, 0);
}

TEST_F(Positions, PartsThatNobodyCanMakeAgainAreNotVerified) {
  ASSERT_EQ(replay(problem(), "out", kSplit).exit_code, 0);
  ProblemFile file = read_problem_file(*this / "out" / "rock_pile_step000080.h5");
  std::ranges::fill(file.position, 0.0);
  write_problem_file(*this / "nowhere.h5", file);
  const ProgramResult result = run_cleave({"verify", *this / "nowhere.h5"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_NE(result.out.find("cannot be split again: geometric: the positions of the bodies are not known"),
            std::string::npos)
      << result.out;
}

TEST_F(Positions, AllLeavesOutWhatTheRunCannotUse) {
  const ProgramResult skipping =
      replay(problem(), "skipping", {"--partitioner", "all", "--skip-small-islands", "--repeats", "1"});
  EXPECT_EQ(skipping.exit_code, 0) << skipping.err;
  EXPECT_NE(
      skipping.err.find(
          "--partitioner all leaves out single, which has no max-bodies, as --skip-small-islands needs\n"),
      std::string::npos)
      << skipping.err;
  // Named itself, it is refused.
  const ProgramResult named = replay(problem(), "named", {"--partitioner", "single", "--skip-small-islands"});
  EXPECT_EQ(named.exit_code, 1);
  EXPECT_NE(named.err.find("partitioner single has no max-bodies"), std::string::npos) << named.err;
}

// Everything that this scene can be split by, in trees that another process splits again, to one solution.
TEST_F(Positions, AllPartitionersSplitByRecursion) {
  const Arguments split = {
      "--partitioner", "all,karger@trials=5", "--solver", "exact,pivot:schur-nested", "--repeats", "1"};
  const ProgramResult nested = replay(problem(), "nested", split);
  ASSERT_EQ(nested.exit_code, 0) << nested.err;
  const CsvTable rows = read_csv(*this / "nested/steps.csv");
  const std::vector<std::string> made = rows.column("partitioner");
  int split_by = 0;
  for (const PartitionerEntry& entry : partitioners()) {
    const std::string name = entry.name;
    if (!entry.unavailable.empty() || name == "file" || partitioner_row(name).traits.needs_groups) continue;
    EXPECT_GT(std::ranges::count(made, name), 0) << name;
    ++split_by;
  }
  EXPECT_GE(split_by, 11);
  for (const std::string& status : rows.column("status")) EXPECT_EQ(status, "ok");
  EXPECT_EQ(run_cleave({"verify", *this / "nested"}).exit_code, 0);
}

}  // namespace
}  // namespace cleave
