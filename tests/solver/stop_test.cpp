// A solve that its caller ends: at the next iteration, out of every solver, which then solves as if nothing
// had been.
#include "harness/base/stop.h"

#include <gtest/gtest.h>

#include <atomic>
#include <string>

#include "solver/direct_solver.h"
#include "solver/linear/dense_cholesky.h"
#include "solver/registry.h"
#include "tests/solver/problem_makers.h"

namespace cleave {
namespace {

StepProblem small_pile() { return make_pile(1, {.columns = 2, .rows = 1, .layers = 3}); }

std::vector<double> solved(StepSolver& solver, const StepProblem& problem) {
  Solution solution{problem.warm_impulse, {}};
  solver.solve(problem, sliced_parts(problem.body_count(), 2), solution);
  return solution.impulse;
}

TEST(Stop, EndsEverySolverWhichThenSolvesAsIfNew) {
  const StepProblem problem = small_pile();
  for (const std::string& name : all_solver_names()) {
    SCOPED_TRACE(name);
    std::atomic<bool> stop = false;
    const auto solver = make_step_solver(name, {.stop = &stop});
    stop = true;
    EXPECT_THROW(solved(*solver, problem), Stopped);
    stop = false;
    EXPECT_EQ(solved(*solver, problem), solved(*make_step_solver(name), problem));
  }
}

// Asks for the end in the middle of its own work.
class Stopping : public Strategy {
 public:
  Stopping(std::atomic<bool>& stop, int& factorizations) : stop_(stop), factorizations_(factorizations) {}
  bool run(SolveState& state) override {
    while (true) {
      stop_ = factorizations_ == 3;
      state.factor_free();
      ++factorizations_;
    }
  }

 private:
  std::atomic<bool>& stop_;
  int& factorizations_;
};

TEST(Stop, TakesEffectAtTheNextFactorisation) {
  std::atomic<bool> stop = false;
  int factorizations = 0;
  const auto solver = make_direct_solver("interior-point", "monolithic", {.stop = &stop}, Settings(),
                                         std::make_unique<Stopping>(stop, factorizations));
  EXPECT_THROW(solved(*solver, small_pile()), Stopped);
  EXPECT_EQ(factorizations, 3);
}

TEST(Stop, EndsADenseFactorisationOnAnyNumberOfThreads) {
  for (const int threads : {1, 2, 3}) {
    SCOPED_TRACE(threads);
    std::atomic<bool> stop = true;
    StageClock clock(threads);
    ParallelTasks tasks(clock, threads, &stop);
    DenseCholesky matrix;
    const auto fill = [&matrix] {
      matrix.resize(500);
      for (int p = 0; p < matrix.panel_count(); ++p)
        matrix.fill_panel(p, [](int row, int column) { return row == column ? 4.0 : 0.001; });
    };
    fill();
    EXPECT_THROW(matrix.factor(tasks), Stopped);
    stop = false;
    fill();
    EXPECT_TRUE(matrix.factor(tasks));
  }
}

}  // namespace
}  // namespace cleave
