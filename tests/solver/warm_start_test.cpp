// What warm impulses change: which strategy `auto` picks on stiff steps, and whether `pivot` sweeps at all.
// Never the answer.
#include <gtest/gtest.h>

#include <string>

#include "solver/registry.h"
#include "tests/solver/problem_makers.h"
#include "tests/solver/seeded_random.h"
#include "tests/solver/solver_checks.h"

namespace cleave {
namespace {

constexpr PileOptions kStiff{.layers = 4, .cfm = 1e-8}, kSoft{.layers = 4, .cfm = 1e-2};

struct Answer {
  SolveSummary summary;
  Solution solution;
};

Answer solve(const std::string& solver, const StepProblem& problem, const std::vector<double>& warm_impulse) {
  Answer answer{{}, cold_start(problem)};
  answer.solution.impulse = warm_impulse;
  answer.summary = make_step_solver(solver, {})
                       ->solve(problem, std::vector<int>(problem.body_count(), 0), answer.solution);
  EXPECT_TRUE(is_exact(problem, answer.summary, answer.solution)) << solver;
  return answer;
}

// The same bodies under loads that differ by so much, m/s.
StepProblem next_step(StepProblem problem, double by) {
  SeededRandom random(5);
  for (double& value : problem.free_velocity) value += by * random.uniform(-1, 1);
  return problem;
}

TEST(WarmStart, AutoPivotsOnStiffStepsThatAreNearlySolved) {
  const StepProblem problem = make_pile(7, kStiff);
  const Answer cold = solve("exact", problem, cold_start(problem).impulse);
  EXPECT_EQ(cold.summary.auto_reason, "stiff");
  EXPECT_EQ(cold.summary.strategy, "interior-point");
  const StepProblem next = next_step(problem, 1e-6);
  const Answer warm = solve("exact", next, cold.solution.impulse);
  EXPECT_EQ(warm.summary.auto_reason, "warm");
  EXPECT_EQ(warm.summary.strategy, "pivot");
  EXPECT_LT(2 * warm.summary.factorizations, cold.summary.factorizations);
  EXPECT_TRUE(velocities_agree(next, warm.solution.velocity,
                               solve("exact", next, cold_start(next).impulse).solution.velocity, 1e-9));
}

TEST(WarmStart, AutoDoesNotWhereLoadsHaveChanged) {
  const StepProblem problem = make_pile(7, kStiff);
  const Answer cold = solve("exact", problem, cold_start(problem).impulse);
  EXPECT_EQ(solve("exact", next_step(problem, 1), cold.solution.impulse).summary.auto_reason, "stiff");
}

// Sweeps in single precision would leave other last digits.
TEST(WarmStart, PivotDoesNotSweepWhereStatesAreRight) {
  const StepProblem problem = make_pile(7, kSoft);
  const Answer cold = solve("pivot:monolithic", problem, cold_start(problem).impulse);
  const Answer warm = solve("pivot:monolithic", problem, cold.solution.impulse);
  const Answer bare = solve("pivot:monolithic@predictor-sweeps=0", problem, cold.solution.impulse);
  EXPECT_EQ(warm.summary.factorizations, 1);
  EXPECT_TRUE(same_bytes(warm.solution.impulse, bare.solution.impulse));
}

TEST(WarmStart, PivotSweepsWhereTheyAreNot) {
  const StepProblem problem = make_pile(7, kSoft);
  const std::vector<double> none = cold_start(problem).impulse;
  const Answer swept = solve("pivot:monolithic", problem, none);
  EXPECT_LT(swept.summary.factorizations,
            solve("pivot:monolithic@predictor-sweeps=0", problem, none).summary.factorizations);
}

}  // namespace
}  // namespace cleave
