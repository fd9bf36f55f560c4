#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "solver/registry.h"
#include "solver/step_solver.h"
#include "tests/solver/allocation_counter.h"
#include "tests/solver/problem_makers.h"
#include "tests/solver/solver_checks.h"

namespace cleave {
namespace {

TEST(AllocationCountTest, CountsEveryFormOfNew) {
  long count = 0;
  {
    const AllocationCount allocations;
    auto single = std::make_unique<int>(1);
    std::vector<double> many(100);
    struct alignas(64) Wide {
      double values[8];
    };
    auto wide = std::make_unique<Wide>();
    asm volatile("" ::"g"(single.get()), "g"(many.data()), "g"(wide.get()) : "memory");  // keeps the calls
    count = allocations.count();
  }
  EXPECT_EQ(count, 3);
}

TEST(AllocationCountTest, IsSwitchedOff) {
  std::vector<double> before(10);
  const AllocationCount allocations;
  EXPECT_EQ(allocations.count(), 0);
}

class AllocationTest : public testing::TestWithParam<std::string> {
 protected:
  void second_solve_allocates_nothing(const StepProblem& problem, int threads, bool session = false);
};

// Every strategy on every kernel but the oracle, whose matrices are Eigen's.
std::vector<std::string> solver_names() {
  std::vector<std::string> names = {"exact"};
  for (const StrategyRow& strategy : strategy_table()) {
    for (const KernelRow& kernel : kernel_table()) {
      if (std::string_view(kernel.name) == "dense" || !runs_on(strategy, kernel)) continue;
      names.push_back(std::string(strategy.name) + ":" + std::string(kernel.name));
    }
  }
  return names;
}

void AllocationTest::second_solve_allocates_nothing(const StepProblem& problem, int threads, bool session) {
  const std::vector<int> parts = sliced_parts(problem.body_count(), 4);
  SolveOptions options;
  options.threads = threads;
  options.session = session;
  const auto solver = make_step_solver(GetParam() + "@reuse-analysis=true", options);
  Solution first = cold_start(problem);
  ASSERT_TRUE(is_exact(problem, solver->solve(problem, parts, first), first));

  Solution second = first;
  std::fill(second.impulse.begin(), second.impulse.end(), 0);
  SolveSummary summary;
  long count = -1;
  {
    const AllocationCount allocations;
    summary = solver->solve(problem, parts, second);
    count = allocations.count();
  }
  EXPECT_EQ(count, 0) << problem.row_count() << " rows, " << threads << " threads"
                      << (session ? ", session" : "");
  EXPECT_TRUE(is_exact(problem, summary, second));
}

// The structure is new to a solver once; on two threads the interface is factored with look-ahead.
TEST_P(AllocationTest, SecondSolveOfOneStructureAllocatesNothing) {
  // Soft enough for those that may miss: why a solve failed is a text, and that is allocated.
  const double cfm = may_miss(GetParam()) ? 1e-1 : 1e-5;
  for (const int threads : {1, 2}) {
    second_solve_allocates_nothing(make_pile(5, {.columns = 3, .rows = 3, .layers = 3, .cfm = cfm}), threads);
    second_solve_allocates_nothing(make_chain(5, {.links = 30, .extra_joints = 5, .closed = true}), threads);
  }
}

TEST_P(AllocationTest, SecondSolveOfASessionAllocatesNothing) {
  if (may_miss(GetParam())) return;
  second_solve_allocates_nothing(make_pile(5, {.columns = 3, .rows = 3, .layers = 3}), 1, true);
}

INSTANTIATE_TEST_SUITE_P(Solvers, AllocationTest, testing::ValuesIn(solver_names()), [](const auto& info) {
  std::string name = info.param;
  std::ranges::replace_if(
      name, [](char c) { return c == '-' || c == ':'; }, '_');
  return name;
});

}  // namespace
}  // namespace cleave
