// --session where a factor serves on, within a step and from step to step: the answers are those of the same
// run in which every system has a factor of its own.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/harness/run_program.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

CsvTable rows_of(const Arguments& arguments, const fs::path& out) {
  const ProgramResult result = run_cleave(Arguments{"run"} + arguments + Arguments{"--out", out});
  EXPECT_EQ(result.exit_code, 0) << result.err;  // every row is ok
  EXPECT_EQ(run_cleave({"verify", out}).exit_code, 0);
  return read_csv(out / "steps.csv");
}

struct BothWays {
  CsvTable alone, session;
};

BothWays run_both_ways(const Arguments& arguments, const TemporaryDirectory& directory) {
  return {rows_of(arguments + Arguments{"--repeats", "1"}, directory / "alone"),
          rows_of(arguments + Arguments{"--session"}, directory / "session")};
}

int sum(const CsvTable& table, const std::string& column) {
  int total = 0;
  for (const std::string& cell : table.column(column)) total += std::stoi(cell);
  return total;
}

// The spread of a row is from the velocities that move the world, which is in no session: where the worlds go
// the same way, velocities of both runs are that near to the same ones.
void expect_same_velocities(const BothWays& both) {
  for (const char* column : {"step", "solver", "problem_hash", "state_hash"})
    EXPECT_EQ(both.session.column(column), both.alone.column(column)) << column;
  for (const CsvTable* table : {&both.alone, &both.session})
    for (const std::string& spread : table->column("velocity_spread_m_per_s"))
      EXPECT_LE(std::stod(spread), 1e-9);
  for (std::size_t row = 0; row < both.session.rows.size(); ++row) {
    const double energy_j = std::stod(both.alone.at(row, "kinetic_energy_j"));
    EXPECT_NEAR(std::stod(both.session.at(row, "kinetic_energy_j")), energy_j, 1e-9 * (1 + energy_j));
  }
}

void expect_own_factors(const CsvTable& table) {
  EXPECT_EQ(sum(table, "factor_reuses"), 0);
  EXPECT_EQ(sum(table, "cg_iterations"), 0);
}

// A silo stands from the start, yet rows change sides in every step, so that the factor of the step before
// would take more iterations than a new one costs. It is the second system of a step that a factor serves.
TEST(SessionFactor, ASiloAtRestFactorsLess) {
  const TemporaryDirectory directory;
  const BothWays both = run_both_ways(
      {"--scene", "silo", "--bodies", "1000", "--steps", "24", "--measure-every", "1", "--solver", "exact"},
      directory);
  ASSERT_EQ(both.session.rows.size(), 24u);
  expect_same_velocities(both);
  expect_own_factors(both.alone);
  EXPECT_GT(sum(both.session, "factor_reuses"), 0);
  EXPECT_GE(sum(both.session, "cg_iterations"), sum(both.session, "factor_reuses"));
  EXPECT_LT(sum(both.session, "factorizations"), sum(both.alone, "factorizations"));
}

constexpr int kBeads = 400;

std::string bead(int index) { return "\"bead[" + std::to_string(index) + "]\""; }

// Beads that are hung up one by one and pushed, each held to others near and far, so that the factor is
// nearly full: dear to make, cheap to use. Of joints alone no row changes sides.
void write_net(const fs::path& path) {
  std::ofstream file(path);
  file << "[[body]]\ngroup = \"bead\"\nshape = \"sphere\"\nradius_m = 0.5\nmass_kg = 1\n"
       << "position_m = [0, 0, 0]\ngrid = { count = [1, 1, " << kBeads << "], spacing_m = [1, 1, 1.5] }\n"
       << "velocity_m_per_s = [{ from = -1, to = 1 }, { from = -1, to = 1 }, 0]\n";
  for (int i = 0; i < kBeads; ++i) {
    file << "[[joint]]\nkind = \"ball\"\nbodies = [" << bead(i) << ", \"world\"]\nanchor_m = [0, 0, "
         << 1.5 * i << "]\n";
    for (const int away : {1, 5, 23, 61, 97, 111, 131, 149})
      if (i + away < kBeads)
        file << "[[joint]]\nkind = \"fixed\"\nbodies = [" << bead(i) << ", " << bead(i + away) << "]\n";
  }
}

class NetOfJoints : public testing::Test {
 protected:
  NetOfJoints() { write_net(directory_ / "net.toml"); }
  // Soft joints, so that the net swings on while its factor grows old.
  Arguments arguments() const {
    return {"--scene",         "file@path=" + (directory_ / "net.toml").string(),
            "--cfm",           "1e-3",
            "--steps",         "12",
            "--measure-every", "1",
            "--solver",        "exact,pivot:schur-bodies,pivot:schur-nested",
            "--partitioner",   "mindp",
            "--refiner",       "none"};
  }

  TemporaryDirectory directory_;
};

TEST_F(NetOfJoints, OneFactorServesAllSteps) {
  const BothWays both = run_both_ways(arguments(), directory_);
  ASSERT_EQ(both.session.rows.size(), 36u);
  expect_same_velocities(both);
  expect_own_factors(both.alone);
  for (std::size_t row = 0; row < both.session.rows.size(); ++row) {
    const bool is_first = both.session.at(row, "step") == "0";
    EXPECT_EQ(both.session.at(row, "factorizations"), is_first ? "1" : "0") << "row " << row;
    EXPECT_EQ(std::stoi(both.session.at(row, "factor_reuses")) > 0, !is_first) << "row " << row;
    EXPECT_EQ(std::stoi(both.session.at(row, "cg_iterations")) > 0, !is_first) << "row " << row;
  }
}

// Counted arithmetic decides whether a factor serves on, never time.
TEST_F(NetOfJoints, ThreadsChangeNothing) {
  const Arguments session = arguments() + Arguments{"--session"};
  const CsvTable one = rows_of(session, directory_ / "1"),
                 two = rows_of(session + Arguments{"--threads", "2"}, directory_ / "2");
  for (const char* column : {"solver", "factorizations", "factor_reuses", "cg_iterations", "solution_hash"})
    EXPECT_EQ(one.column(column), two.column(column)) << column;
}

}  // namespace
}  // namespace cleave
