// scripts/ablate_interior_point with the programs themselves, on a few problems.
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/harness/run_program.h"

namespace cleave {
namespace {

ProgramResult ablate(const TemporaryDirectory& directory, const std::string& constants) {
  ::setenv("CLEAVE_PROGRAM", CLEAVE_PROGRAM, 1);
  return run_program(std::string(CLEAVE_SOURCE_DIR) + "/scripts/ablate_interior_point",
                     {"--scene", "ladder_heavy_top", "--cfm", "1e-8,0", "--constant", constants, "--out",
                      directory / "out"});
}

// Factorisations over all problems.
int count(const CsvTable& table, const std::string& constant, const std::string& value) {
  int sum = 0;
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    if (table.at(r, "constant") != constant || table.at(r, "value") != value) continue;
    sum += std::atoi(table.at(r, "factorizations").c_str());
  }
  return sum;
}

TEST(InteriorAblation, CountsEveryValueOnEveryProblem) {
  const TemporaryDirectory directory;
  const ProgramResult result = ablate(directory, "soft_polish,firm_polish");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const CsvTable table = read_csv(directory / "out/interior_point.csv");
  ASSERT_EQ(table.rows.size(), 8u * (1 + 4 + 3));
  const int as_it_is = count(table, "-", "-");
  EXPECT_GT(as_it_is, 8);
  EXPECT_GT(count(table, "firm_polish", "0"), as_it_is);  // never an exact last solve
  EXPECT_EQ(count(table, "soft_polish", "0"), as_it_is);  // no problem is that soft
  EXPECT_EQ(table.rows[0][3], "ladder_heavy_top_cfm_1e-8/ladder_heavy_top_step000080.h5");
  EXPECT_NE(result.out.find("and no problem): `soft_polish`.\n"), std::string::npos) << result.out;
}

TEST(InteriorAblation, AnUnknownConstantIsOneLine) {
  const TemporaryDirectory directory;
  const ProgramResult result = ablate(directory, "firm_polisch");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("--constant has 'firm_polisch', expected some of fixed_width_m_per_s,"),
            std::string::npos)
      << result.err;
  EXPECT_FALSE(std::filesystem::exists(directory / "out/interior_point.csv"));
}

}  // namespace
}  // namespace cleave
