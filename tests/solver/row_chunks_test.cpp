// Light work on rows is dealt out in chunks: all rows once, and the same bytes however many threads there
// are.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "solver/registry.h"
#include "solver/solve_state.h"
#include "tests/solver/problem_makers.h"
#include "tests/solver/solver_checks.h"

namespace cleave {
namespace {

StepProblem pile_of_several_chunks() {
  StepProblem problem = make_pile(11, {.columns = 5, .rows = 5, .layers = 5});
  EXPECT_GT(problem.row_count(), SolveState::kFewRows);
  return problem;
}

TEST(RowChunksTest, HoldEveryRowOnce) {
  const StepProblem problem = pile_of_several_chunks();
  StageClock clock(2);
  SolveState state(read_direct_options({.threads = 2}), clock);
  PreparedStep step;
  step.prepare(problem);
  state.step = &step;
  std::vector<int> visits(problem.row_count());
  state.run_over_rows([&](int first, int last, int) {
    for (int r = first; r < last; ++r) ++visits[r];
  });
  EXPECT_EQ(visits, std::vector<int>(problem.row_count(), 1));
  EXPECT_GT(state.chunk_count(), 1u);
  const int end_of_first = step.rows_of(step.group_chunks()[0]).second;
  for (const int greatest : {0, end_of_first - 1, end_of_first, problem.row_count() - 1})
    EXPECT_EQ(state.greatest_over_rows([&](int r) { return r == greatest ? 2.0 : 1.0 * (r % 2); }), 2.0)
        << greatest;
  EXPECT_EQ(state.greatest_over_rows([](int r) { return r == 7 ? std::nan("") : 1.0; }),
            std::numeric_limits<double>::infinity());
}

TEST(RowChunksTest, ThreadsDoNotChangeTheBytes) {
  const StepProblem problem = pile_of_several_chunks();
  for (const char* strategy : {"pivot:monolithic", "interior-point:monolithic"}) {
    Solution one = cold_start(problem);
    ASSERT_TRUE(is_exact(problem, make_step_solver(strategy, {})->solve(problem, {}, one), one)) << strategy;
    for (const int threads : {2, 3}) {
      Solution other = cold_start(problem);
      make_step_solver(strategy, {.threads = threads})->solve(problem, {}, other);
      EXPECT_EQ(other.impulse, one.impulse) << strategy << ", " << threads << " threads";
    }
  }
}

}  // namespace
}  // namespace cleave
