// Checks of the checkers at the cut: a Schur kernel that is wrong in one cut row, or in its copy of one, must
// not pass as exact.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <string>

#include "solver/registry.h"
#include "solver/solve_state.h"
#include "solver/step_solver.h"
#include "solver/strategies/strategy.h"
#include "tests/solver/kernel_by_name.h"
#include "tests/solver/kernel_wrapper.h"
#include "tests/solver/problem_makers.h"
#include "tests/solver/solver_checks.h"

namespace cleave {
namespace {

std::vector<int> cut_rows_of(const StepProblem& problem, const std::vector<int>& part_of_body) {
  std::vector<int> rows;
  for (int r = 0; r < problem.row_count(); ++r) {
    const int a = problem.row_body[2 * r], b = problem.row_body[2 * r + 1];
    if (b >= 0 && part_of_body[a] != part_of_body[b]) rows.push_back(r);
  }
  return rows;
}

bool is_at_bound(const StepProblem& problem, const Solution& solution, int row) {
  return solution.impulse[row] == problem.lower[row] || solution.impulse[row] == problem.upper[row];
}

class InterfaceChecks : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    problem_ = make_pile(21, {.columns = 2, .rows = 2, .layers = 3, .cfm = 1e-4, .mass_ratio = 10});
    parts_ = sliced_parts(problem_.body_count(), 4);
    cut_rows_ = cut_rows_of(problem_, parts_);
    ASSERT_GT(cut_rows_.size(), 50u);
    solution_ = solve(problem_);
    ASSERT_TRUE(judge(problem_, solution_.impulse).exact);
  }

  Solution solve(const StepProblem& problem) const {
    Solution solution = cold_start(problem);
    make_step_solver("pivot:" + GetParam(), {})->solve(problem, parts_, solution);
    return solution;
  }

  StepProblem problem_;
  std::vector<int> parts_, cut_rows_;
  Solution solution_;
};

TEST_P(InterfaceChecks, OneCutImpulseThatIsOffFailsTheJudge) {
  for (const int row : cut_rows_) {
    for (const double off : {-1e-6, 1e-6}) {
      std::vector<double> impulse = solution_.impulse;
      impulse[row] += off;
      EXPECT_FALSE(judge(problem_, impulse).exact) << "row " << row;
    }
  }
}

// The solver's copy of the problem is off in one cut row: it solves that to the last digit, which the judge,
// who knows the true one, does not accept. Rows at a bound would not show it.
TEST_P(InterfaceChecks, OneCutRowThatIsOffInTheSolversCopyFailsTheJudge) {
  const std::vector<std::function<void(StepProblem&, int)>> damages = {
      [](StepProblem& copy, int row) { copy.jacobian[12 * row + 8] += 1e-4; },
      [](StepProblem& copy, int row) { copy.rhs[row] += 1e-6; },
      [](StepProblem& copy, int row) { copy.compliance[row] *= 1.01; },
  };
  int tried = 0;
  for (std::size_t k = 0; k < cut_rows_.size(); k += 5) {
    const int row = cut_rows_[k];
    if (is_at_bound(problem_, solution_, row) || std::abs(solution_.impulse[row]) < 1e-2) continue;
    for (const auto& damage : damages) {
      StepProblem copy = problem_;
      damage(copy, row);
      const Solution wrong = solve(copy);
      EXPECT_TRUE(judge(copy, wrong.impulse).exact) << "row " << row;
      EXPECT_FALSE(judge(problem_, wrong.impulse).exact) << "row " << row;
      ++tried;
    }
  }
  EXPECT_GE(tried, 9);
}

// Adds a little to the increments of one row's impulse and of its first body's velocity in every solve.
class SpoiltKernel : public KernelWrapper {
 public:
  SpoiltKernel(std::unique_ptr<Kernel> true_kernel, int row, int body, double off)
      : KernelWrapper(std::move(true_kernel)), row_(row), body_(body), off_(off) {}
  void solve(std::span<const double> f_v, std::span<const double> f_r, std::span<double> dv,
             std::span<double> dlambda, ParallelTasks& tasks, const RowsAround& around) override {
    KernelWrapper::solve(f_v, f_r, dv, dlambda, tasks, {around.before, {}});
    dlambda[row_] += off_;
    dv[6 * body_] += off_;
    run_work(around.after, *step_, tasks);
  }

 private:
  int row_, body_;
  double off_;
};

// Whether the strategy says that it succeeded, and what the judge says of its impulses.
struct Claim {
  bool success = false;
  bool exact = false;
};

Claim run_strategy(const StrategyRow& strategy, Kernel& kernel, const StepProblem& problem,
                   const std::vector<int>& parts) {
  StageClock clock;
  clock.start();
  PreparedStep step;
  step.prepare(problem);
  SolveState state(read_direct_options({}), clock);
  SolveSummary summary;
  kernel.analyze(step, parts, state.tasks);
  const std::vector<double> cold(problem.row_count(), 0.0);
  state.begin(step, kernel, summary, cold);
  state.part_of_body = parts;
  Claim claim;
  claim.success = strategy.make(defaults_of(strategy))->run(state);
  claim.exact = judge(problem, state.impulse).exact;
  return claim;
}

TEST_P(InterfaceChecks, StrategiesDoNotBelieveAKernelThatIsOffInOneCutRow) {
  for (const StrategyRow& strategy : strategy_table()) {
    if (strategy.make == nullptr) continue;
    SCOPED_TRACE(strategy.name);
    SpoiltKernel true_kernel(make_kernel(GetParam()), 0, 0, 0.0);
    const Claim truth = run_strategy(strategy, true_kernel, problem_, parts_);
    EXPECT_EQ(truth.success, truth.exact);
    int tried = 0;
    for (std::size_t k = 0; k < cut_rows_.size() && tried < 5; k += 7) {
      const int row = cut_rows_[k];
      if (is_at_bound(problem_, solution_, row)) continue;
      SpoiltKernel kernel(make_kernel(GetParam()), row, problem_.row_body[2 * row], 1e-5);
      const Claim claim = run_strategy(strategy, kernel, problem_, parts_);
      EXPECT_EQ(claim.success, claim.exact) << "row " << row;
      EXPECT_FALSE(claim.success) << "row " << row;
      ++tried;
    }
    EXPECT_GE(tried, 3);
  }
}

INSTANTIATE_TEST_SUITE_P(SchurKernels, InterfaceChecks, testing::Values("schur-rows", "schur-bodies"),
                         [](const auto& info) { return info.param == "schur-rows" ? "rows" : "bodies"; });

}  // namespace
}  // namespace cleave
