// Groups of bodies: from a scene, from its problem files, and where nobody names any.
#include <gtest/gtest.h>

#include <set>

#include "harness/files/problem_file.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;
const Arguments kCrane = {"--scene", "crane", "--links", "20", "--dt", "0.001", "--cfm", "1e-10"};
const Arguments kPile = {"--scene", "rock_pile", "--bodies", "12"};
const Arguments kSplit = {"--partitioner", "semantic,semantic@split=chunks,mindp",
                          "--refiner",     "none,fm",
                          "--max-bodies",  "6",
                          "--repeats",     "1"};

class Groups : public testing::Test {
 protected:
  std::string operator/(const std::string& name) const { return directory_ / name; }
  ProgramResult run(const Arguments& scene, const std::string& out, const Arguments& more) const {
    return run_cleave(Arguments{"run", "--steps", "3", "--measure-every", "3", "--out", *this / out} + scene +
                      more);
  }
  // The path of its problem at step 2.
  std::string record(const Arguments& scene) const {
    const ProgramResult result =
        run_cleave(Arguments{"record", "--at", "2", "--out", *this / ("made_" + scene[1])} + scene);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return *this / ("made_" + scene[1] + "/" + scene[1] + "_step000002.h5");
  }
  ProgramResult replay(const std::string& file, const std::string& out, const Arguments& more) const {
    return run_cleave(Arguments{"replay", file, "--write-solutions", "--out", *this / out} + more);
  }

  TemporaryDirectory directory_;
};

// Of the crane with 20 links: chassis and four outriggers; turntable, counterweight, six sections, eight
// links of the pendant, mast, hoist; links and load.
TEST_F(Groups, AWorldAndItsProblemFileSplitAlike) {
  const ProgramResult live_run = run(kCrane, "run", kSplit);
  ASSERT_EQ(live_run.exit_code, 0) << live_run.err;
  const std::string file = record(kCrane);
  std::vector<int> expected(5, 0);
  expected.insert(expected.end(), 18, 1);
  expected.insert(expected.end(), 21, 2);
  EXPECT_EQ(read_problem_file(file).body_group, expected);
  const ProgramResult replayed = replay(file, "replayed", kSplit);
  ASSERT_EQ(replayed.exit_code, 0) << replayed.err;
  const CsvTable live = read_csv(*this / "run/steps.csv"), again = read_csv(*this / "replayed/steps.csv");
  ASSERT_EQ(live.rows.size(), 6u);
  for (const char* column : {"partitioner", "parts", "interface_rows_before", "interface_rows",
                             "max_part_bodies", "split", "problem_hash", "solution_hash"})
    EXPECT_EQ(live.column(column), again.column(column)) << column;
  EXPECT_EQ(live.at(0, "parts"), "3");
  EXPECT_EQ(live.at(0, "max_part_bodies"), "21");
  EXPECT_EQ(live.at(0, "split"), "whole");
  // Two joints between groups: the slewing hinge, driven, and the top of the cable.
  EXPECT_EQ(live.at(0, "interface_rows"), "9");
  EXPECT_EQ(live.at(2, "parts"), "8");
  EXPECT_EQ(live.at(2, "max_part_bodies"), "6");
  EXPECT_EQ(live.at(2, "split"), "chunks");
  EXPECT_EQ(live.at(4, "split"), "-");
  EXPECT_EQ(run_cleave({"verify", *this / "replayed"}).exit_code, 0);
}

TEST_F(Groups, ASceneWithoutThemIsARefusedRow) {
  for (const bool recorded : {false, true}) {
    const std::string out = recorded ? "replayed" : "run";
    const ProgramResult result = recorded ? replay(record(kPile), out, kSplit) : run(kPile, out, kSplit);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    const CsvTable table = read_csv(*this / (out + "/steps.csv"));
    ASSERT_EQ(table.rows.size(), 6u);
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
      const bool is_refused = row < 4;
      EXPECT_EQ(table.at(row, "status"), is_refused ? "refused" : "ok");
      if (is_refused) {
        EXPECT_EQ(table.at(row, "status_reason"),
                  "semantic: the scene names no groups of bodies, which it splits by");
      }
    }
  }
}

TEST_F(Groups, AllLeavesOutWhatNeedsThemWhereThereAreNone) {
  const Arguments all = {"--partitioner", "all,mindp@max-bodies=4", "--refiner", "none", "--repeats", "1"};
  const auto split_by = [&](const std::string& out) {
    std::set<std::string> names;
    for (const std::string& name : read_csv(*this / (out + "/steps.csv")).column("partitioner"))
      names.insert(name);
    return names;
  };
  const ProgramResult pile = run(kPile, "pile", all), crane = run(kCrane, "crane", all);
  EXPECT_EQ(pile.exit_code, 0) << pile.err;
  EXPECT_EQ(crane.exit_code, 0) << crane.err;
  EXPECT_NE(
      pile.err.find(
          "--partitioner all leaves out semantic, which splits by groups of bodies, and scene rock_pile "
          "names none\n"),
      std::string::npos)
      << pile.err;
  EXPECT_EQ(crane.err.find("leaves out semantic"), std::string::npos) << crane.err;
  EXPECT_FALSE(split_by("pile").contains("semantic"));
  EXPECT_TRUE(split_by("crane").contains("semantic"));
  EXPECT_TRUE(split_by("pile").contains("mindp@max-bodies=4"));

  const std::string file = record(kPile);
  const ProgramResult replayed = replay(file, "replayed", all);
  EXPECT_EQ(replayed.exit_code, 0) << replayed.err;
  EXPECT_NE(replayed.err.find("leaves out semantic, which splits by groups of bodies, and " + file +
                              " names none\n"),
            std::string::npos)
      << replayed.err;
  EXPECT_EQ(split_by("replayed"), split_by("pile"));
}

}  // namespace
}  // namespace cleave
