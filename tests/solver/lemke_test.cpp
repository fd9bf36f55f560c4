// Solver `lemke` on step problems: bounds of every shape against the oracle, rows that depend on others with
// and without compliance, contradictions, and its limit of rows.
#include <gtest/gtest.h>

#include <algorithm>
#include <new>
#include <string>

#include "solver/registry.h"
#include "solver/step_solver.h"
#include "tests/solver/enumeration_oracle.h"
#include "tests/solver/problem_makers.h"
#include "tests/solver/solver_checks.h"

namespace cleave {
namespace {

struct Solved {
  SolveSummary summary;
  Solution solution;
};

Solved solve_by(const std::string& solver, const StepProblem& problem) {
  Solved solved{{}, cold_start(problem)};
  solved.summary =
      make_step_solver(solver)->solve(problem, single_part(problem.body_count()), solved.solution);
  return solved;
}

void set_compliance(StepProblem& problem, double compliance) {
  std::ranges::fill(problem.compliance, compliance);
}

void expect_oracle(const SmallProblemOptions& options, double tolerance) {
  for (int seed = 0; seed < 500; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const StepProblem problem = make_small_problem(seed, options);
    const Solved solved = solve_by("lemke", problem);
    EXPECT_TRUE(is_exact(problem, solved.summary, solved.solution));
    EXPECT_TRUE(velocities_agree(problem, solved.solution.velocity, solve_by_enumeration(problem).velocity,
                                 tolerance));
  }
}

// Not one miss: bilateral rows, bounds on one side and both, equal bounds, friction boxes, copies and
// mirrored copies.
TEST(LemkeTest, SmallProblemsMatchTheOracle) {
  expect_oracle({}, 1e-9);
  expect_oracle({.least_cfm = 1e-8, .most_cfm = 1e-5, .feasible = true}, 1e-9);
  expect_oracle({.least_cfm = 1e-14, .most_cfm = 1e-8, .feasible = true}, 1e-7);
}

TEST(LemkeTest, RowsThatDependOnOthersNeedNoCompliance) {
  for (int seed = 0; seed < 1000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    StepProblem problem = make_small_problem(seed, {.feasible = true});
    set_compliance(problem, 0);
    const Solved solved = solve_by("lemke", problem);
    EXPECT_TRUE(is_exact(problem, solved.summary, solved.solution));
  }
}

// Four contacts hold each face where three would do, so that every basis is degenerate.
TEST(LemkeTest, PilesMatchTheDenseOracle) {
  for (const double cfm : {1e-4, 1e-6, 0.0}) {
    for (const double mu : {0.0, 0.5}) {
      SCOPED_TRACE(testing::Message() << "cfm " << cfm << ", mu " << mu);
      const StepProblem problem =
          make_pile(1, {.columns = 2, .rows = 1, .layers = 3, .cfm = cfm, .mu = mu, .mass_ratio = 100});
      const Solved solved = solve_by("lemke", problem), oracle = solve_by("dense", problem);
      EXPECT_TRUE(is_exact(problem, solved.summary, solved.solution));
      EXPECT_TRUE(velocities_agree(problem, solved.solution.velocity, oracle.solution.velocity, 1e-7));
      EXPECT_GT(solved.summary.iterations, 0);
    }
  }
}

// The same bilateral row once more.
void append_copy(StepProblem& problem, int row) {
  RowSpec copy;
  copy.body_a = problem.row_body[2 * row];
  copy.body_b = problem.row_body[2 * row + 1];
  std::copy_n(problem.jacobian.begin() + 12 * row, 6, copy.jacobian_a.begin());
  std::copy_n(problem.jacobian.begin() + 12 * row + 6, 6, copy.jacobian_b.begin());
  copy.rhs = problem.rhs[row];
  copy.compliance = problem.compliance[row];
  copy.constraint = 1 + *std::ranges::max_element(problem.row_constraint);
  append_row(problem, copy);
}

TEST(LemkeTest, ChainsOfBilateralRowsAloneNeedNoPivot) {
  const StepProblem ring =
      make_chain(2, {.links = 12, .hinges = true, .closed = true, .doubled = true, .cfm = 1e-5});
  StepProblem copied = make_chain(2, {.links = 12, .cfm = 0});
  for (const int row : {0, 7, 8}) append_copy(copied, row);
  for (const StepProblem& problem : {ring, copied}) {
    const Solved solved = solve_by("lemke", problem), oracle = solve_by("dense", problem);
    EXPECT_TRUE(is_exact(problem, solved.summary, solved.solution));
    EXPECT_TRUE(velocities_agree(problem, solved.solution.velocity, oracle.solution.velocity, 1e-7));
    EXPECT_EQ(solved.summary.iterations, 0);
  }
}

// One body that has to rise along z by at least, or by exactly, what its rows say.
StepProblem make_rising(std::initializer_list<double> least, bool exactly) {
  StepProblem problem;
  problem.h_s = kTestStep_s;
  append_body(problem, 1, {1, 1, 1}, {});
  double sign = 1;
  for (const double rise : least) {
    RowSpec row;
    row.jacobian_a = {0, 0, sign, 0, 0, 0};
    row.rhs = sign * rise;
    if (!exactly) row.lower = 0, row.kind = RowKind::normal;
    append_row(problem, row);
    sign = -sign;
  }
  return problem;
}

TEST(LemkeTest, ContradictionsEndInAStatusThatSaysSo) {
  // At least 2 and at most 1: no z >= 0 has M z + q >= 0.
  const StepProblem walls = make_rising({2, 1}, false);
  const Solved squeezed = solve_by("lemke", walls);
  EXPECT_EQ(squeezed.summary.status, SolveStatus::not_converged);
  EXPECT_TRUE(squeezed.summary.message.starts_with("a ray after ")) << squeezed.summary.message;
  // Exactly 2 and exactly 1: there is nothing to pivot on.
  const StepProblem joints = make_rising({2, 1}, true);
  const Solved torn = solve_by("lemke", joints);
  EXPECT_EQ(torn.summary.status, SolveStatus::not_converged);
  EXPECT_TRUE(torn.summary.message.starts_with("residual ")) << torn.summary.message;
  // At least 1 and at most 2.
  const Solved fine = solve_by("lemke", make_rising({1, 2}, false));
  EXPECT_EQ(fine.summary.status, SolveStatus::ok);
  EXPECT_NEAR(fine.solution.velocity[2], 1, 1e-12);
}

// Many redundant rows of hardly any compliance: more than rounding, less than a pivot can tell from it.
TEST(LemkeTest, WherePivotsDrownInRoundingItSaysSo) {
  int missed = 0;
  for (const double cfm : {1e-9, 1e-10, 1e-11, 1e-12}) {
    const StepProblem problem = make_pile(0, {.columns = 2, .rows = 2, .layers = 3, .cfm = cfm});
    const Solved solved = solve_by("lemke", problem);
    EXPECT_TRUE(is_honest(problem, solved.summary, solved.solution)) << "cfm " << cfm;
    if (solved.summary.status != SolveStatus::ok) ++missed;
  }
  EXPECT_GE(missed, 1);
}

TEST(LemkeTest, MoreRowsThanAllowedAreRefusedByName) {
  const StepProblem problem = make_pile(1, {.columns = 1, .rows = 1, .layers = 2});
  ASSERT_EQ(problem.row_count(), 24);
  EXPECT_EQ(solve_by("lemke@lemke-max-rows=24", problem).summary.status, SolveStatus::ok);
  const Solved refused = solve_by("lemke@lemke-max-rows=23", problem);
  EXPECT_EQ(refused.summary.status, SolveStatus::refused);
  EXPECT_EQ(refused.summary.message, "24 rows, more than lemke-max-rows 23");
}

TEST(LemkeTest, MemoryIsAskedForFirst) {
  const StepProblem problem = make_pile(1, {.columns = 1, .rows = 1, .layers = 2});
  Solution solution = cold_start(problem);
  const auto solver = make_step_solver("lemke", {.memory_limit_bytes = 10000});
  const SolveSummary refused = solver->solve(problem, single_part(problem.body_count()), solution);
  EXPECT_EQ(refused.status, SolveStatus::out_of_memory);
  EXPECT_TRUE(refused.message.ends_with(", the limit is 10.0 kB")) << refused.message;
  EXPECT_GT(refused.factor_predicted_mb, 0.01);
  EXPECT_GT(solve_by("lemke", problem).summary.factor_predicted_mb, 0.01);
}

}  // namespace
}  // namespace cleave
