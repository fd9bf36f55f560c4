// One step of 20 000 bodies through the program: sparse factors solve it within a limit of memory in which
// the paper's dense interface has no room.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "solver/step_problem.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

constexpr double kMemoryLimit_mb = 400;

// Boxes early on, as they settle on each other. Five sweeps of Gauss-Seidel move them, which is cheap and
// leaves the recorded row above the limit; it is the problem that counts.
fs::path record_silo(const fs::path& out) {
  const ProgramResult result = run_cleave({"record", "--scene", "silo", "--bodies", "20000", "--at", "2",
                                           "--advance", "pgs@sweeps=5", "--out", out});
  EXPECT_EQ(result.exit_code, 2) << result.err;
  return out / "silo_step000002.h5";
}

// A row a solver. Parts are large, so that interfaces are small.
CsvTable replay(const fs::path& file, const fs::path& out) {
  const std::string limit_gb = std::to_string(1e-3 * kMemoryLimit_mb);
  const ProgramResult result =
      run_cleave({"replay", file, "--solver", "exact,pivot:schur-nested,schur", "--partitioner", "multilevel",
                  "--refiner", "none", "--max-bodies", "200", "--threads", "2", "--repeats", "1",
                  "--memory-limit", limit_gb, "--out", out});
  EXPECT_EQ(result.exit_code, 2) << result.err;  // one row is refused
  EXPECT_EQ(run_cleave({"verify", out}).exit_code, 0);
  return read_csv(out / "steps.csv");
}

std::size_t row_of(const CsvTable& table, const std::string& solver) {
  const std::vector<std::string> solvers = table.column("solver");
  return static_cast<std::size_t>(std::ranges::find(solvers, solver) - solvers.begin());
}

double number(const CsvTable& table, std::size_t row, const std::string& column) {
  return std::stod(table.at(row, column));
}

void expect_exact(const CsvTable& table, std::size_t row) {
  EXPECT_EQ(table.at(row, "bodies"), "20000");
  EXPECT_GT(number(table, row, "rows"), 200'000);
  EXPECT_EQ(table.at(row, "status"), "ok") << table.at(row, "status_reason");
  EXPECT_LE(number(table, row, "residual_m_per_s"),
            kExactLimit * std::max(1.0, number(table, row, "largest_free_velocity_m_per_s")));
  EXPECT_LT(number(table, row, "factor_predicted_mb"), kMemoryLimit_mb);
}

void expect_refused_for_memory(const CsvTable& table, std::size_t row) {
  EXPECT_EQ(table.at(row, "status"), "out_of_memory");
  EXPECT_EQ(table.at(row, "t_s_ms"), "nan");
  EXPECT_GT(number(table, row, "factor_predicted_mb"), kMemoryLimit_mb);
  const std::string& reason = table.at(row, "status_reason");
  EXPECT_TRUE(reason.starts_with("the factorisation needs ")) << reason;
  EXPECT_TRUE(reason.ends_with(", the limit is 400.0 MB")) << reason;
}

TEST(LargeRun, SparseFactorsFitWhereTheDenseInterfaceDoesNot) {
  const TemporaryDirectory directory;
  const CsvTable table = replay(record_silo(directory / "recorded"), directory / "out");
  ASSERT_EQ(table.rows.size(), 3u);
  const std::size_t exact = row_of(table, "exact"), nested = row_of(table, "pivot:schur-nested");
  expect_exact(table, exact);
  expect_exact(table, nested);
  const double energy_j = number(table, exact, "kinetic_energy_j");
  EXPECT_NEAR(number(table, nested, "kinetic_energy_j"), energy_j, 1e-9 * energy_j);
  expect_refused_for_memory(table, row_of(table, "schur"));
}

}  // namespace
}  // namespace cleave
