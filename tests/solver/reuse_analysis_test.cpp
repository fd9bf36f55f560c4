// The symbolic analysis is kept while the pairs of bodies that share a row have a place in its pattern, and
// not beyond; answers are those of a fresh solver.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "solver/kernels/kernel.h"
#include "solver/registry.h"
#include "tests/solver/problem_makers.h"
#include "tests/solver/solver_checks.h"

namespace cleave {
namespace {

template <class Value>
void keep(std::vector<Value>& values, const std::vector<int>& rows, int width) {
  std::vector<Value> kept;
  for (int row : rows)
    kept.insert(kept.end(), values.begin() + width * row, values.begin() + width * (row + 1));
  values = kept;
}

// The problem without the constraints (all rows of one contact or joint) that `drop` names.
template <class Drop>
StepProblem without(StepProblem problem, Drop drop) {
  std::vector<int> rows, new_row(problem.row_count(), -1);
  for (int r = 0; r < problem.row_count(); ++r) {
    if (drop(problem.row_body[2 * r], problem.row_body[2 * r + 1], problem.row_constraint[r])) continue;
    new_row[r] = static_cast<int>(rows.size());
    rows.push_back(r);
  }
  for (int& normal : problem.friction_row) normal = normal < 0 ? -1 : new_row[normal];
  keep(problem.row_body, rows, 2);
  keep(problem.jacobian, rows, 12);
  keep(problem.contact_point, rows, 3);
  for (auto* values : {&problem.rhs, &problem.compliance, &problem.lower, &problem.upper,
                       &problem.friction_coefficient, &problem.warm_impulse}) {
    keep(*values, rows, 1);
  }
  keep(problem.row_kind, rows, 1);
  keep(problem.friction_row, rows, 1);
  keep(problem.row_constraint, rows, 1);
  EXPECT_EQ(find_problem_error(problem), "");
  return problem;
}

std::vector<std::string> kernel_names() {
  std::vector<std::string> names;
  for (const KernelRow& row : kernel_table()) {
    if (row.traits.runs_as == nullptr) names.emplace_back(row.name);
  }
  return names;
}

class ReuseAnalysisTest : public testing::TestWithParam<std::string> {};

TEST_P(ReuseAnalysisTest, SolvesEverySubsetAndWhatLiesOutside) {
  const StepProblem whole = make_pile(7, {.columns = 3, .rows = 3, .layers = 3});
  const StepProblem fewer = without(whole, [](int, int, int constraint) { return constraint % 3 == 0; });
  const StepProblem fewer_pairs =
      without(whole, [](int a, int b, int) { return b >= 0 && (a + b) % 4 == 0; });
  const std::vector<int> parts = sliced_parts(whole.body_count(), 4);
  for (const char* strategy : {"pivot", "interior-point"}) {
    const auto used = make_step_solver(std::string(strategy) + ":" + GetParam() + "@reuse-analysis=true");
    for (const StepProblem* problem : {&fewer_pairs, &whole, &fewer, &fewer_pairs, &whole, &fewer}) {
      Solution kept = cold_start(*problem), fresh = cold_start(*problem);
      ASSERT_TRUE(is_exact(*problem, used->solve(*problem, parts, kept), kept)) << strategy;
      const auto other = make_step_solver(std::string(strategy) + ":" + GetParam(), {});
      ASSERT_TRUE(is_exact(*problem, other->solve(*problem, parts, fresh), fresh)) << strategy;
      EXPECT_TRUE(velocities_agree(*problem, kept.velocity, fresh.velocity, 1e-9));
    }
  }
}

// Nothing but the analysis is kept. The second problem has the rows and the compliance of the first and
// starts with its active set, so that by its weights a factor of the first would fit.
TEST_P(ReuseAnalysisTest, GivesTheBytesOfAFreshSolverOnOtherNumbers) {
  const StepProblem first = make_pile(7, {.columns = 3, .rows = 3, .layers = 3});
  StepProblem second = first;
  for (double& mass : second.mass) mass *= 2;
  const std::vector<int> parts = sliced_parts(first.body_count(), 4);
  const std::string solver = "pivot:" + GetParam() + "@predictor-sweeps=0";
  const auto used = make_step_solver(solver + "@reuse-analysis=true");
  Solution solution = cold_start(first);
  ASSERT_TRUE(is_exact(first, used->solve(first, parts, solution), solution));
  Solution kept = solution, fresh = solution;
  const SolveSummary of_kept = used->solve(second, parts, kept);
  const SolveSummary of_fresh = make_step_solver(solver)->solve(second, parts, fresh);
  EXPECT_EQ(kept.impulse, fresh.impulse);
  EXPECT_EQ(of_kept.factorizations, of_fresh.factorizations);
  EXPECT_EQ(of_kept.factor_mflop_done, of_fresh.factor_mflop_done);
}

TEST_P(ReuseAnalysisTest, KeepsThePatternOfTheWholeForItsSubset) {
  const StepProblem whole = make_pile(7, {.columns = 3, .rows = 3, .layers = 3});
  const StepProblem fewer = without(whole, [](int a, int b, int) { return b >= 0 && (a + b) % 4 == 0; });
  const std::vector<int> parts = single_part(whole.body_count());
  StageClock clock;
  clock.start();
  ParallelTasks tasks(clock, 1);
  PreparedStep step;
  for (const KernelRow& row : kernel_table()) {
    if (row.name != GetParam()) continue;
    const auto kernel = row.make(defaults_of(row)), fresh = row.make(defaults_of(row));
    step.prepare(whole);
    kernel->analyze(step, parts, tasks);
    const double of_whole = kernel->local_mflop() + kernel->interface_mflop();
    step.prepare(fewer);
    ASSERT_TRUE(kernel->rebind(step, parts, tasks));
    EXPECT_EQ(kernel->local_mflop() + kernel->interface_mflop(), of_whole);
    fresh->analyze(step, parts, tasks);
    if (GetParam() == "dense") continue;  // which has no pattern
    const double of_fewer = fresh->local_mflop() + fresh->interface_mflop();
    EXPECT_LT(of_fewer, of_whole);
    step.prepare(whole);
    if (fresh->rebind(step, parts, tasks)) {  // schur-rows analyses again the parts that need it
      EXPECT_GT(fresh->local_mflop() + fresh->interface_mflop(), of_fewer);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kernels, ReuseAnalysisTest, testing::ValuesIn(kernel_names()), [](const auto& info) {
  std::string name = info.param;
  std::ranges::replace(name, '-', '_');
  return name;
});

}  // namespace
}  // namespace cleave
