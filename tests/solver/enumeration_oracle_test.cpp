#include "tests/solver/enumeration_oracle.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "tests/solver/problem_makers.h"

namespace cleave {
namespace {

// A 2 kg body that falls at 1 m/s on a floor below its center, with the compliance given.
StepProblem make_falling_body(double compliance) {
  StepProblem problem;
  problem.h_s = kTestStep_s;
  append_body(problem, 2, {1, 1, 1}, {0.3, 0, -1, 0, 0, 0});
  RowSpec floor;
  floor.jacobian_a = {0, 0, 1, 0, 0, 0};
  floor.compliance = compliance;
  floor.lower = 0;
  floor.kind = RowKind::normal;
  append_row(problem, floor);
  return problem;
}

TEST(EnumerationOracleTest, StopsAFallingBody) {
  const OracleSolution solution = solve_by_enumeration(make_falling_body(0.5));
  EXPECT_DOUBLE_EQ(solution.impulse[0], 1.0);  // -1 + lambda / 2 + lambda / 2 = 0
  EXPECT_DOUBLE_EQ(solution.velocity[2], -0.5);
  EXPECT_DOUBLE_EQ(solution.velocity[0], 0.3);
  EXPECT_EQ(solution.sets, 2);
}

TEST(EnumerationOracleTest, LetsARisingBodyGo) {
  StepProblem problem = make_falling_body(0.5);
  problem.free_velocity[2] = 1;
  EXPECT_EQ(solve_by_enumeration(problem).impulse[0], 0);
}

TEST(EnumerationOracleTest, HoldsABoxedRowAtItsBound) {
  StepProblem problem = make_falling_body(0.5);
  problem.lower[0] = -0.25;
  problem.upper[0] = 0.25;
  EXPECT_EQ(solve_by_enumeration(problem).impulse[0], 0.25);
  problem.free_velocity[2] = 1;
  const OracleSolution solution = solve_by_enumeration(problem);
  EXPECT_EQ(solution.impulse[0], -0.25);
  EXPECT_EQ(solution.sets, 3);
}

TEST(EnumerationOracleTest, SharesTheLoadBetweenEqualRows) {
  StepProblem problem = make_falling_body(0.5);
  RowSpec copy;
  copy.jacobian_a = {0, 0, 1, 0, 0, 0};
  copy.compliance = 0.5;
  append_row(problem, copy);
  const OracleSolution solution = solve_by_enumeration(problem);
  EXPECT_NEAR(solution.impulse[0], 2.0 / 3, 1e-15);  // -1 + 2 lambda / 2 + lambda / 2 = 0
  EXPECT_NEAR(solution.impulse[1], 2.0 / 3, 1e-15);
}

TEST(EnumerationOracleTest, FindsACompatibleSetForEverySeed) {
  for (int seed = 0; seed < 300; ++seed) {
    EXPECT_LE(solve_by_enumeration(make_small_problem(seed)).worst_violation_m_per_s, 1e-12)
        << "seed " << seed;
  }
}

TEST(EnumerationOracleTest, RefusesWhatItCannotEnumerate) {
  EXPECT_THROW(solve_by_enumeration(make_pile(1, {})), std::invalid_argument);
  EXPECT_THROW(solve_by_enumeration(make_falling_body(0)), std::invalid_argument);
}

}  // namespace
}  // namespace cleave
