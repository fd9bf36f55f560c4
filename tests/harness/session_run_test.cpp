// --session as a user gives it: the same world, every step solved, only the measured ones in rows.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/harness/run_program.h"

namespace cleave {
namespace {

const Arguments kSolvers = {
    "--partitioner", "mix", "--refiner", "fm", "--solver", "schur,pivot:schur-bodies,exact"};
const Arguments kPile = {"--scene", "rock_pile", "--bodies", "20"};

CsvTable rows_of(const Arguments& arguments, const std::filesystem::path& out) {
  const ProgramResult result = run_cleave(arguments + kSolvers + Arguments{"--out", out});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(run_cleave({"verify", out}).exit_code, 0);
  return read_csv(out / "steps.csv");
}

TEST(SessionRun, TheWorldGoesTheSameWay) {
  const TemporaryDirectory directory;
  const Arguments run = Arguments{"run", "--steps", "60", "--measure-every", "20"} + kPile;
  const CsvTable alone = rows_of(run + Arguments{"--repeats", "1"}, directory / "alone");
  const CsvTable session = rows_of(run + Arguments{"--session"}, directory / "session");
  ASSERT_EQ(session.rows.size(), 9u);
  for (const char* column : {"step", "problem_hash", "state_hash", "status", "solver"})
    EXPECT_EQ(session.column(column), alone.column(column)) << column;
  for (std::size_t row = 0; row < session.rows.size(); ++row) {
    EXPECT_EQ(session.at(row, "session"), "1");
    EXPECT_EQ(alone.at(row, "session"), "0");
    EXPECT_EQ(session.at(row, "repeat_count"), "1");
    EXPECT_EQ(alone.at(row, "factor_reuses"), "0");
    EXPECT_EQ(session.at(row, "t_s_model_p2_ms"), "nan");
  }
}

// What a measured row says depends on the steps before, measured or not.
TEST(SessionRun, EveryStepIsSolved) {
  const TemporaryDirectory directory;
  const Arguments run = Arguments{"run", "--session", "--steps", "60"} + kPile;
  const CsvTable often = rows_of(run + Arguments{"--measure-every", "1"}, directory / "often");
  const CsvTable seldom = rows_of(run + Arguments{"--measure-every", "30"}, directory / "seldom");
  ASSERT_EQ(often.rows.size(), 180u);
  ASSERT_EQ(seldom.rows.size(), 6u);
  for (std::size_t row = 0; row < 3; ++row)
    EXPECT_EQ(seldom.at(3 + row, "solution_hash"), often.at(59 * 3 + row, "solution_hash"));
}

TEST(SessionReplay, TakesConsecutiveSteps) {
  const TemporaryDirectory directory;
  ASSERT_EQ(run_cleave(Arguments{"record", "--at", "30,31,32,40", "--out", directory / "problems"} + kPile)
                .exit_code,
            0);
  const auto file = [&](const std::string& step) {
    return (directory / "problems/rock_pile_step0000").string() + step + ".h5";
  };
  const Arguments replay = {"replay", "--session"};
  const CsvTable rows = rows_of(replay + Arguments{file("30"), file("31"), file("32")}, directory / "out");
  EXPECT_EQ(rows.rows.size(), 9u);
  EXPECT_EQ(rows.at(8, "session"), "1");
  for (const Arguments& files : {Arguments{file("32"), file("40")}, {file("31"), file("30")}}) {
    const ProgramResult result = run_cleave(replay + files + Arguments{"--out", directory / "none"});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.err.find(files[1] + " is not the step after that of " + files[0]), std::string::npos)
        << result.err;
    EXPECT_FALSE(std::filesystem::exists(directory / "none"));
  }
}

TEST(SessionRun, SolvesEveryStepOnce) {
  const ProgramResult result =
      run_cleave(Arguments{"run", "--session", "--repeats", "3", "--out", "none"} + kPile);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("--repeats: 3 is not 1, which --session allows"), std::string::npos)
      << result.err;
}

}  // namespace
}  // namespace cleave
