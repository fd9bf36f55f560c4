// run --explain-model: worlds in which one thing is modelled for nothing, and is found; others in which it is
// not.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "harness/experiment/model_changes.h"
#include "solver/registry.h"
#include "tests/harness/machine_columns.h"
#include "tests/harness/problem_file_sample.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

const std::string kGround = "[ground]\n";

std::string box(const std::string& position, const std::string& more = "") {
  return "[[body]]\nshape = \"box\"\nedges_m = [1, 1, 1]\nmass_kg = 1\nposition_m = " + position + "\n" +
         more;
}

// Findings by name, of a world in a file.
class ExplainModel : public ::testing::Test {
 protected:
  ProgramResult run(const std::string& world, const Words& more = {}, const std::string& name = "out") {
    std::ofstream(scratch_ / "world.toml") << world;
    Words words = {"run",     "--scene", "file@path=" + (scratch_ / "world.toml").string(),
                   "--steps", "20",      "--solver",
                   "exact",   "--out",   scratch_ / name};
    words.insert(words.end(), more.begin(), more.end());
    return run_cleave(words);
  }
  std::map<std::string, long> found(const std::string& world, Words more = {}) {
    more.insert(more.end(), {"--explain-model", "--force"});
    const ProgramResult result = run(world, more);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    told_ = result.err;
    table_ = read_csv(scratch_ / "out" / "explain_model.csv");
    std::map<std::string, long> counts;
    for (std::size_t row = 0; row < table_.rows.size(); ++row)
      counts[table_.at(row, "finding")] = std::stol(table_.at(row, "found"));
    EXPECT_EQ(counts.size(), 6u);
    return counts;
  }
  double number(const std::string& finding, const std::string& column) const {
    for (std::size_t row = 0; row < table_.rows.size(); ++row)
      if (table_.at(row, "finding") == finding) return std::stod(table_.at(row, column));
    ADD_FAILURE() << finding;
    return 0;
  }

  TemporaryDirectory scratch_;
  CsvTable table_;
  std::string told_;
};

TEST_F(ExplainModel, FindsBodiesThatNeverMoved) {
  const auto counts =
      found(kGround + box("[0, 0, 0.4999]") + box("[5, 0, 0.4999]", "velocity_m_per_s = [2, 0, 0]\n"));
  EXPECT_EQ(counts.at("body_at_rest"), 1);
  EXPECT_EQ(number("body_at_rest", "of"), 2);
  EXPECT_GT(number("body_at_rest", "rows_share"), 0.3);
  EXPECT_LT(number("body_at_rest", "change_m_per_s"), 1e-2);
  EXPECT_NE(told_.find("body_at_rest"), std::string::npos) << told_;
}

TEST_F(ExplainModel, FindsContactsThatNeverTouch) {
  const std::string rises = box("[0, 0, 0.4999]", "velocity_m_per_s = [0, 0, 2]\n"),
                    rests = box("[5, 0, 0.4999]");
  EXPECT_EQ(found(kGround + rises + rests).at("contact_apart"), 1);
  EXPECT_EQ(number("contact_apart", "change_m_per_s"), 0);
  EXPECT_EQ(found(kGround + rests).at("contact_apart"), 0);
  EXPECT_NE(told_.find("not found: contact_apart"), std::string::npos) << told_;
}

TEST_F(ExplainModel, FindsFrictionThatCarriesNothing) {
  EXPECT_EQ(found(kGround + box("[0, 0, 0.4999]")).at("friction_unloaded"), 1);
  EXPECT_NEAR(number("friction_unloaded", "rows_share"), 2.0 / 3, 1e-12);
  EXPECT_LT(number("friction_unloaded", "change_m_per_s"), 1e-9);
  EXPECT_EQ(found(kGround + box("[0, 0, 0.4999]", "velocity_m_per_s = [1, 0, 0]\n")).at("friction_unloaded"),
            0);
}

// On a slope of ten degrees: sticks with mu 0.5, slides with 0.05.
TEST_F(ExplainModel, FindsFrictionThatOnlySticks) {
  const std::string slope =
      "[[plane]]\nnormal = [0.17364817766693033, 0, 0.984807753012208]\noffset_m = 0\n" +
      box("[0.0867, 0, 0.4922]", "orientation = [0.9961946980917455, 0, 0.08715574274765817, 0]\n");
  EXPECT_EQ(found(slope, {"--mu", "0.5"}).at("friction_never_at_bound"), 1);
  EXPECT_LT(number("friction_never_at_bound", "change_m_per_s"), 1e-9);
  EXPECT_EQ(number("friction_never_at_bound", "rows_share"), 0);
  EXPECT_EQ(found(slope, {"--mu", "0.5", "--friction", "cone"}).at("friction_never_at_bound"), 1);
  EXPECT_EQ(found(slope, {"--mu", "0.05"}).at("friction_never_at_bound"), 0);
  EXPECT_EQ(found(slope, {"--mu", "0.05", "--friction", "cone"}).at("friction_never_at_bound"), 0);
}

TEST_F(ExplainModel, FindsTheContactCap) {
  const std::string rests = kGround + box("[0, 0, 0.4999]");
  EXPECT_EQ(found(rests, {"--contact-cap", "4"}).at("contact_cap"), 1);
  EXPECT_NEAR(number("contact_cap", "rows_share"), 0.5, 1e-12);
  EXPECT_EQ(found(rests, {"--contact-cap", "8"}).at("contact_cap"), 0);
  // The cap is one of pairs of geoms: four contacts with each of two grounds are no eight with one.
  const std::string between = "[[plane]]\nnormal = [0, 0, 1]\noffset_m = 0\n" + rests;
  EXPECT_EQ(found(between, {"--contact-cap", "8"}).at("contact_cap"), 0);
  EXPECT_EQ(found(between, {"--contact-cap", "4"}).at("contact_cap"), 1);
  EXPECT_NEAR(number("contact_cap", "rows_share"), 0.5, 1e-12);
}

// Along the diagonal of its box friction is sqrt 2 times what a cone allows.
TEST_F(ExplainModel, FindsBoxesBeyondTheCone) {
  const auto counts = found(kGround + box("[0, 0, 0.4999]", "velocity_m_per_s = [3, 3, 0]\n"));
  EXPECT_GT(counts.at("box_beyond_cone"), 0);
  EXPECT_GT(number("box_beyond_cone", "change_m_per_s"), 1e-3);
  EXPECT_EQ(found(kGround + box("[0, 0, 0.4999]")).at("box_beyond_cone"), 0);
  EXPECT_EQ(found(kGround + box("[0, 0, 0.4999]", "velocity_m_per_s = [3, 3, 0]\n"), {"--friction", "cone"})
                .at("box_beyond_cone"),
            0);
}

TEST_F(ExplainModel, ChangesNoRowAndVerifies) {
  const std::string world = kGround + box("[0, 0, 0.4999]") + box("[0.2, 0, 1.5]");
  ASSERT_EQ(run(world, {}, "without").exit_code, 0);
  found(world);
  CsvTable with = read_csv(scratch_ / "out" / "steps.csv"),
           without = read_csv(scratch_ / "without" / "steps.csv");
  ASSERT_EQ(with.rows.size(), without.rows.size());
  for (std::size_t row = 0; row < with.rows.size(); ++row)
    for (const std::string& column : with.header) {
      if (!is_of_the_machine(column)) {
        EXPECT_EQ(with.at(row, column), without.at(row, column)) << column;
      }
    }
  EXPECT_EQ(run_cleave({"verify", scratch_ / "out"}).exit_code, 0);
  std::ofstream(scratch_ / "out" / "explain_model.csv", std::ios::app) << "x";
  EXPECT_EQ(run_cleave({"verify", scratch_ / "out"}).exit_code, 3);
}

TEST_F(ExplainModel, IsOfOneWorld) {
  const ProgramResult result =
      run(kGround + box("[0, 0, 0.4999]"), {"--explain-model", "--mode", "separate"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("--explain-model: watches one world"), std::string::npos) << result.err;
}

std::vector<double> velocity_of(const StepProblem& problem) {
  Solution solution{problem.warm_impulse, {}};
  EXPECT_TRUE(has_result(make_step_solver("exact")->solve(problem, {}, solution).status));
  return solution.velocity;
}

// As if they were too heavy for anything to move them.
TEST(ModelChanges, StaticBodiesAreThoseOfInfiniteMass) {
  const StepProblem problem = sample_problem(6, 11);
  const std::vector<char> fixed = {0, 1, 0, 0, 1, 1};
  StepProblem heavy = problem;
  for (int i = 0; i < 6; ++i)
    for (int k = 0; k < 36; ++k) heavy.mass[36 * i + k] *= fixed[i] != 0 ? 1e12 : 1;
  for (int i = 0; i < 6; ++i)
    for (int k = 0; k < 6; ++k) heavy.free_velocity[6 * i + k] *= fixed[i] == 0;
  const StepProblem changed = with_static_bodies(problem, fixed);
  EXPECT_EQ(find_problem_error(changed), "");
  const std::vector<double> expected = velocity_of(heavy), found = velocity_of(changed);
  for (std::size_t k = 0; k < found.size(); ++k) EXPECT_NEAR(found[k], expected[k], 1e-8) << k;
}

TEST(ModelChanges, FrictionRowsGoWithTheirNormalRow) {
  const StepProblem problem = sample_problem(4, 3);
  std::vector<char> gone(problem.rhs.size(), 0);
  int normal = 0;
  while (problem.row_kind[normal] != RowKind::normal) ++normal;
  gone[normal] = 1;
  const StepProblem reduced = without_rows(problem, gone);
  EXPECT_EQ(reduced.row_count(), problem.row_count() - 2);
  EXPECT_EQ(find_problem_error(reduced), "");
}

}  // namespace
}  // namespace cleave
