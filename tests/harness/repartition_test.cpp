// --repartition as a user gives it.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "harness/experiment/repartition.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

const Arguments kPile = {"run",          "--scene",  "rock_pile",       "--bodies", "30",
                         "--max-bodies", "6",        "--partitioner",   "mix",      "--refiner",
                         "none,fm",      "--solver", "schur,monolithic"};

CsvTable rows_of(const Arguments& more, const std::filesystem::path& out) {
  const ProgramResult result = run_cleave(kPile + more + Arguments{"--out", out});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const ProgramResult verified = run_cleave({"verify", out});
  EXPECT_EQ(verified.exit_code, 0) << verified.out;
  return read_csv(out / "steps.csv");
}

TEST(Repartition, TheWorldGoesTheSameWayAndRunsRepeat) {
  const TemporaryDirectory directory;
  const CsvTable anew =
      rows_of({"--steps", "60", "--measure-every", "10", "--repeats", "2"}, directory / "anew");
  const Arguments kept = {"--steps",   "60", "--measure-every", "10",
                          "--repeats", "2",  "--repartition",   "on-change"};
  const CsvTable one = rows_of(kept, directory / "one"), two = rows_of(kept, directory / "two");
  EXPECT_EQ(one.column("state_hash"), anew.column("state_hash"));
  EXPECT_EQ(one.column("solution_hash"), two.column("solution_hash"));
  EXPECT_GT(std::ranges::count(one.column("partition_origin"), "repaired"), 0);
  EXPECT_EQ(std::ranges::count(anew.column("partition_origin"), "fresh"), 12);
  EXPECT_EQ(anew.at(2, "partition_origin"), "-");
}

// What a measured row says depends on the steps before, measured or not.
TEST(Repartition, EveryStepIsFollowed) {
  const TemporaryDirectory directory;
  const Arguments rule = {"--steps", "40", "--repeats", "1", "--repartition", "drift:0.1"};
  const CsvTable often = rows_of(rule + Arguments{"--measure-every", "1"}, directory / "often");
  const CsvTable seldom = rows_of(rule + Arguments{"--measure-every", "40"}, directory / "seldom");
  const CsvTable session =
      rows_of(rule + Arguments{"--measure-every", "40", "--session"}, directory / "session");
  for (std::size_t row = 0; row < 2; ++row)
    for (const char* column : {"partition_origin", "interface_rows", "parts"}) {
      EXPECT_EQ(seldom.at(row, column), often.at(39 * 3 + row, column)) << column;
      EXPECT_EQ(session.at(row, column), often.at(39 * 3 + row, column)) << column;
    }
}

TEST(Repartition, IsNewEveryKSteps) {
  const TemporaryDirectory directory;
  const CsvTable rows =
      rows_of({"--steps", "12", "--repeats", "2", "--repartition", "every:4"}, directory / "out");
  for (std::size_t row = 0; row < rows.rows.size(); ++row)
    if (rows.at(row, "partitioner") != "-") {
      EXPECT_EQ(rows.at(row, "partition_origin") == "fresh", row / 3 % 4 == 0) << "row " << row;
    }
}

TEST(Repartition, NamesWhatIsWrong) {
  for (const auto& [text, told] :
       std::vector<std::pair<std::string, std::string>>{{"evry:3", "'every'"},
                                                        {"every:0", "0 is not in [1, inf)"},
                                                        {"drift:-1", "-1 is not in [0, inf)"},
                                                        {"every", "every:K"},
                                                        {"always:2", "always"}}) {
    const ProgramResult result = run_cleave(kPile + Arguments{"--repartition", text, "--out", "none"});
    EXPECT_EQ(result.exit_code, 1) << text;
    EXPECT_NE(result.err.find("--repartition: "), std::string::npos) << result.err;
    EXPECT_NE(result.err.find(told), std::string::npos) << result.err;
  }
}

TEST(Repartition, WhatMeansTheSameIsWrittenAlike) {
  EXPECT_EQ(read_repartition("--repartition", "drift:1e-1").text, "drift:0.1");
  EXPECT_EQ(read_repartition("--repartition", "every:05").text, "every:5");
}

TEST(Repartition, IsReplayedOverConsecutiveStepsAndStored) {
  const TemporaryDirectory directory;
  ASSERT_EQ(run_cleave({"record", "--scene", "rock_pile", "--bodies", "30", "--at", "30,31,32,40", "--out",
                        directory / "in"})
                .exit_code,
            0);
  const auto file = [&](const std::string& step) {
    return (directory / "in/rock_pile_step0000").string() + step + ".h5";
  };
  const Arguments replay = {
      "replay", "--repartition", "on-change", "--write-solutions", "--max-bodies", "6",        "--repeats",
      "1",      "--partitioner", "mix",       "--refiner",         "fm",           "--solver", "schur"};
  ASSERT_EQ(run_cleave(replay + Arguments{file("30"), file("31"), file("32"), "--out", directory / "out"})
                .exit_code,
            0);
  const CsvTable rows = read_csv(directory / "out/steps.csv");
  EXPECT_EQ(rows.at(0, "partition_origin"), "fresh");
  EXPECT_NE(rows.at(2, "partition_origin"), "fresh");
  const ProgramResult verified = run_cleave({"verify", directory / "out"});
  EXPECT_EQ(verified.exit_code, 0) << verified.out;
  EXPECT_NE(verified.out.find(" from the step before"), std::string::npos);
  const ProgramResult refused =
      run_cleave(replay + Arguments{file("32"), file("40"), "--out", directory / "none"});
  EXPECT_NE(refused.err.find("which --repartition on-change asks for"), std::string::npos) << refused.err;
}

}  // namespace
}  // namespace cleave
