// Boxes turned in their tangent planes: the interior point through every kernel against the same problem in
// turned rows.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "solver/registry.h"
#include "solver/step_solver.h"
#include "solver/strategies/interior_iterate.h"
#include "tests/solver/allocation_counter.h"
#include "tests/solver/kernel_by_name.h"
#include "tests/solver/problem_makers.h"
#include "tests/solver/solver_checks.h"
#include "tests/solver/turned_boxes.h"

namespace cleave {
namespace {

// Of the tangent impulses along the axes of turned boxes, those at a bound that is not zero.
int count_at_bounds(const StepProblem& problem, std::span<const double> impulse) {
  const std::vector<double> axes = along_axes(problem, impulse);
  int count = 0;
  for (int r = 0; r + 2 < problem.row_count(); ++r) {
    for (int k = r + 1; k <= r + 2 && problem.box_angle_rad[r] != 0; ++k) {
      const double bound = problem.upper[k];
      count += bound > 0 && std::abs(std::abs(axes[k]) - bound) <= 1e-12 * bound;
    }
  }
  return count;
}

class TurnedBoxTest : public testing::TestWithParam<std::string> {};  // a kernel

TEST_P(TurnedBoxTest, InteriorPointAgreesWithTheSameProblemInTurnedRows) {
  const std::string solver = "interior-point:" + GetParam();
  int at_bounds = 0;
  for (const double cfm : {1e-4, 1e-5, 1e-8, 1e-11, 0.0}) {
    for (int seed = 0; seed < 4; ++seed) {
      SCOPED_TRACE("cfm " + std::to_string(cfm) + ", seed " + std::to_string(seed));
      const StepProblem problem = make_turned_pile(seed, cfm), turned = in_turned_rows(problem);
      ASSERT_EQ(find_problem_error(problem), "");
      SeededRandom random(seed);
      const std::vector<int> parts = random_parts(random, problem.body_count(), 4);
      const Answer answer = solve(solver, problem, parts), expected = solve(solver, turned, parts);
      EXPECT_TRUE(is_exact(problem, answer.summary, answer.solution));
      EXPECT_TRUE(is_exact(turned, expected.summary, expected.solution));
      EXPECT_EQ(answer.summary.strategy, "interior-point");
      EXPECT_TRUE(velocities_agree(problem, answer.solution.velocity, expected.solution.velocity, 1e-9));
      StepProblem straight = problem;
      straight.box_angle_rad.clear();
      const Answer other = solve(solver, straight, parts);
      EXPECT_GT(largest_difference(other.solution.velocity, expected.solution.velocity), 1e-6);
      at_bounds += count_at_bounds(problem, answer.solution.impulse);
    }
  }
  EXPECT_GT(at_bounds, 100);
}

TEST_P(TurnedBoxTest, WarmStartsAreTurned) {
  const StepProblem problem = make_turned_pile(3, 1e-5);
  const std::vector<int> parts = sliced_parts(problem.body_count(), 4);
  const Answer cold = solve("interior-point:" + GetParam(), problem, parts);
  Answer warm{cold.solution, {}};
  warm.summary = make_step_solver("interior-point:" + GetParam(), {})->solve(problem, parts, warm.solution);
  EXPECT_TRUE(is_exact(problem, warm.summary, warm.solution));
  EXPECT_LT(warm.summary.factorizations, cold.summary.factorizations);
}

TEST_P(TurnedBoxTest, SecondSolveAllocatesNothing) {
  if (GetParam() == "dense") return;  // its matrices are Eigen's
  const StepProblem problem = make_turned_pile(5, 1e-5);
  const std::vector<int> parts = sliced_parts(problem.body_count(), 4);
  for (const std::string strategy : {"interior-point:", "auto:"}) {
    const auto solver = make_step_solver(strategy + GetParam() + "@reuse-analysis=true");
    Solution first = cold_start(problem);
    ASSERT_TRUE(is_exact(problem, solver->solve(problem, parts, first), first));
    Solution second = first;
    std::ranges::fill(second.impulse, 0.0);
    const AllocationCount allocations;
    const SolveSummary summary = solver->solve(problem, parts, second);
    EXPECT_EQ(allocations.count(), 0) << strategy;
    EXPECT_EQ(summary.status, SolveStatus::ok);
  }
}

TEST_P(TurnedBoxTest, AnglesOfZeroChangeNoByte) {
  const StepProblem problem = make_pile(2, {.columns = 2, .rows = 2, .layers = 2});
  StepProblem zeros = problem;
  zeros.box_angle_rad.assign(problem.row_count(), 0.0);
  const std::vector<int> parts = sliced_parts(problem.body_count(), 2);
  for (const std::string strategy : {"pivot:", "interior-point:"}) {
    const Answer expected = solve(strategy + GetParam(), problem, parts);
    const Answer answer = solve(strategy + GetParam(), zeros, parts);
    EXPECT_TRUE(same_bytes(answer.solution.impulse, expected.solution.impulse)) << strategy;
    EXPECT_TRUE(same_bytes(answer.solution.velocity, expected.solution.velocity)) << strategy;
  }
}

TEST_P(TurnedBoxTest, AutoTakesTheInteriorPointAndSaysWhy) {
  const StepProblem problem = make_turned_pile(1, 1e-1);  // so soft that it would take pivot
  const std::vector<int> parts = sliced_parts(problem.body_count(), 3);
  const Answer answer = solve("auto:" + GetParam(), problem, parts);
  EXPECT_TRUE(is_exact(problem, answer.summary, answer.solution));
  EXPECT_EQ(answer.summary.strategy, "interior-point");
  EXPECT_EQ(answer.summary.auto_reason, "turned-box");
  EXPECT_EQ(solve("auto:" + GetParam(), in_turned_rows(problem), parts).summary.strategy, "pivot");
}

// What rounding leaves of a direction is measured along the axes too.
TEST_P(TurnedBoxTest, DirectionsSolveTheirOwnSystem) {
  const StepProblem problem = make_turned_pile(4, 1e-5);
  const std::vector<int> parts = sliced_parts(problem.body_count(), 3);
  StageClock clock;
  clock.start();
  PreparedStep step;
  step.prepare(problem);
  SolveState state(read_direct_options({}), clock);
  SolveSummary summary;
  const std::unique_ptr<Kernel> kernel = make_kernel(GetParam());
  kernel->analyze(step, parts, state.tasks);
  const std::vector<double> cold(problem.row_count(), 0.0);
  state.begin(step, *kernel, summary, cold);
  InteriorIterate iterate{InteriorConstants{}};
  iterate.start(state);
  ASSERT_TRUE(iterate.factor(state, kFactoredCompliance));
  iterate.find_direction(state, InteriorIterate::Aim::affine);
  EXPECT_GT(iterate.error(), 1e-3);
  EXPECT_LE(iterate.rounding(state), 1e-10);
}

std::vector<std::string> kernel_names() {
  std::vector<std::string> names;
  for (const KernelRow& row : kernel_table()) names.emplace_back(row.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Kernels, TurnedBoxTest, testing::ValuesIn(kernel_names()), [](const auto& info) {
  std::string name = info.param;
  std::ranges::replace(name, '-', '_');
  return name;
});

}  // namespace
}  // namespace cleave
