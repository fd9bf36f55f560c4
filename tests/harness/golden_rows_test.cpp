// Short runs of every scene against rows that are stored in tests/harness/golden: whatever machine this is,
// the same problems, partitions, solutions and motion, to the last bit.
//
// A change that is meant to change them writes the files anew: CLEAVE_WRITE_GOLDEN=1 in the environment of
// this test. The difference then stands in the commit, for all to see.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <ostream>
#include <utility>

#include "harness/base/names.h"
#include "harness/experiment/algorithms.h"
#include "scenarios/scene.h"
#include "tests/harness/machine_columns.h"
#include "tests/harness/run_program.h"
#include "tests/scenarios/shipped_scenes.h"

namespace cleave {
namespace {

const Arguments kColumns = {"step",
                            "partitioner",
                            "refiner",
                            "solver",
                            "status",
                            "rows",
                            "parts",
                            "cut_pairs",
                            "interface_rows",
                            "iterations",
                            "factorizations",
                            "part_condition_max",
                            "residual_m_per_s",
                            "kinetic_energy_j",
                            "problem_hash",
                            "solution_hash",
                            "state_hash"};

struct Case {
  std::string name;
  Arguments scene;
  friend void PrintTo(const Case& self, std::ostream* out) { *out << self.name; }
};

// The paper's scenes, small; then every other scene as it comes.
std::vector<Case> all_cases() {
  std::vector<Case> cases = {
      {"chain_drop", {"--scene", "chain_drop", "--links", "40", "--steps", "120"}},
      {"log_tower", {"--scene", "log_tower", "--layers", "6", "--steps", "90"}},
      {"rock_pile", {"--scene", "rock_pile", "--bodies", "40", "--steps", "120"}},
      {"large_rock_pile", {"--scene", "large_rock_pile", "--bodies", "50", "--steps", "120"}},
      {"silo", {"--scene", "silo", "--bodies", "30", "--steps", "30"}},
      {"crane", {"--scene", "crane", "--links", "20", "--steps", "60", "--dt", "0.001", "--cfm", "1e-10"}},
      {"mixed_site",
       {"--scene", "mixed_site", "--links", "50", "--rings", "1", "--steps", "60", "--dt", "0.001", "--cfm",
        "1e-10"}},
      {"stiff_pile", {"--scene", "rock_pile", "--bodies", "30", "--steps", "90", "--cfm", "1e-10"}},
  };
  for (const ShippedScene& scene : shipped_scenes()) {
    const bool there = std::ranges::find(cases, scene.name, &Case::name) != cases.end();
    if (there) continue;
    Arguments arguments = arguments_of(scene);
    arguments.insert(arguments.end(), {"--steps", "30"});
    cases.push_back({scene.name, arguments});
  }
  return cases;
}

CsvTable run(const Case& given, const Arguments& combinations) {
  const TemporaryDirectory directory;
  Arguments arguments = {
      "run",   "--measure-every", "30", "--repeats", "1", "--threads", "2", "--max-bodies", "8",
      "--out", directory / "out"};
  arguments.insert(arguments.end(), given.scene.begin(), given.scene.end());
  arguments.insert(arguments.end(), combinations.begin(), combinations.end());
  const ProgramResult result = run_cleave(arguments);
  EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 2) << result.err;  // some solvers may miss
  return read_csv(directory / "out/steps.csv");
}

// What --solver can name without more.
std::vector<std::string> all_solvers() {
  std::vector<std::string> names;
  for (const AlgorithmKind& kind : algorithm_kinds())
    if (std::string(kind.option) == "solver") std::ranges::copy(kind.names, std::back_inserter(names));
  return names;
}

// The golden columns of every combination with the paper's solver, then of every solver with one combination.
std::string golden_text(const Case& given) {
  std::string text = joined(kColumns, ",") + "\n";
  for (const Arguments& combinations :
       {Arguments{"--partitioner", "paper", "--refiner", "paper", "--solver", "schur"},
        Arguments{"--partitioner", "mindp", "--refiner", "fm", "--solver", joined(all_solvers(), ",")}}) {
    const CsvTable table = run(given, combinations);
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
      for (const std::string& column : kColumns) text += table.at(row, column) + ",";
      text.back() = '\n';
    }
  }
  return text;
}

class GoldenRowsTest : public testing::TestWithParam<Case> {};

TEST_P(GoldenRowsTest, AreTheSameOnEveryMachine) {
  const std::string path =
      std::string(CLEAVE_SOURCE_DIR) + "/tests/harness/golden/" + GetParam().name + ".csv";
  const std::string found = golden_text(GetParam());
  if (std::getenv("CLEAVE_WRITE_GOLDEN") != nullptr) {
    std::ofstream(path, std::ios::binary) << found;
    FAIL() << path << " is written; run the test again without CLEAVE_WRITE_GOLDEN";
  }
  const CsvTable stored = read_csv(path), now = parse_csv(found);
  ASSERT_EQ(now.header, stored.header);
  ASSERT_EQ(now.rows.size(), stored.rows.size());
  for (std::size_t row = 0; row < now.rows.size(); ++row) {
    ASSERT_EQ(now.rows[row], stored.rows[row]) << "row " << row + 2 << " of " << path;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, GoldenRowsTest, testing::ValuesIn(all_cases()),
                         [](const auto& info) { return info.param.name; });

// Rows of a run on this processor and of the same run on one without AVX-512, which is emulated.
std::pair<CsvTable, CsvTable> here_and_emulated(const Arguments& scene) {
  const TemporaryDirectory directory;
  const Arguments run = Arguments{"run",
                                  "--repeats",
                                  "1",
                                  "--max-bodies",
                                  "6",
                                  "--refiner",
                                  "fm",
                                  "--partitioner",
                                  "mindp,mix",
                                  "--solver",
                                  "schur,exact,dense,pivot:schur-bodies"};
  const auto arguments = [&](Arguments start, const std::string& out) {
    start.insert(start.end(), run.begin(), run.end());
    start.insert(start.end(), scene.begin(), scene.end());
    start.insert(start.end(), {"--out", directory / out});
    return start;
  };
  EXPECT_EQ(run_cleave(arguments({}, "here")).exit_code, 0);
  EXPECT_EQ(run_program(CLEAVE_EMULATOR, arguments({"-cpu", "Haswell", CLEAVE_PROGRAM}, "there")).exit_code,
            0);
  return {read_csv(directory / "here/steps.csv"), read_csv(directory / "there/steps.csv")};
}

// The tower's interface has more rows than a block of the dense factorisation.
TEST(EmulatedProcessorTest, GivesEveryColumnOfThisOne) {
  int most_unknowns = 0;
  for (const Arguments& scene :
       {Arguments{"--scene", "rock_pile", "--bodies", "20", "--steps", "60", "--measure-every", "20"},
        Arguments{"--scene", "log_tower", "--layers", "6", "--steps", "20", "--measure-every", "20"}}) {
    const auto [here, there] = here_and_emulated(scene);
    ASSERT_EQ(here.rows.size(), there.rows.size());
    ASSERT_GT(here.rows.size(), 0u);
    for (const std::string& column : here.header) {
      if (is_of_the_machine(column)) continue;
      EXPECT_EQ(here.column(column), there.column(column)) << column;
    }
    for (const std::string& unknowns : here.column("interface_unknowns"))
      most_unknowns = std::max(most_unknowns, std::stoi(unknowns));
  }
  EXPECT_GT(most_unknowns, 120);
}

TEST(EmulatedProcessorTest, AProcessorThatIsTooOldGetsOneLine) {
  const ProgramResult result = run_program(CLEAVE_EMULATOR, {"-cpu", "Nehalem", CLEAVE_PROGRAM, "list"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(count_lines(result.err), 1);
  EXPECT_NE(result.err.find("x86-64-v3"), std::string::npos);
  EXPECT_EQ(result.out, "");
}
}  // namespace
}  // namespace cleave
