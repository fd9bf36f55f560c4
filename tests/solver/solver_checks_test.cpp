// The assertions of solver_checks.h must fail on wrong answers: solvers that lie are built here and caught.
#include "tests/solver/solver_checks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/solver/enumeration_oracle.h"
#include "tests/solver/problem_makers.h"

namespace cleave {
namespace {

constexpr int kSeeds = 100;

// Solves a damaged copy of the problem, or damages the solution, and says ok.
class LyingSolver : public StepSolver {
 public:
  std::function<void(StepProblem&)> damage_problem = [](StepProblem&) {};
  std::function<void(Solution&)> damage_solution = [](Solution&) {};
  SolveStatus status = SolveStatus::ok;
  bool uses_partition() const override { return false; }

 private:
  SolveSummary do_solve(const StepProblem& problem, const Parts&, Solution& solution) override {
    StepProblem copy = problem;
    damage_problem(copy);
    OracleSolution oracle = solve_by_enumeration(copy);
    solution.impulse = oracle.impulse;
    solution.velocity = oracle.velocity;
    damage_solution(solution);
    SolveSummary summary;
    summary.status = status;
    return summary;
  }
};

class LyingSolverTest : public testing::Test {
 protected:
  SolveSummary solve(const StepProblem& problem) {
    solution_ = cold_start(problem);
    return solver_.solve(problem, single_part(problem.body_count()), solution_);
  }

  LyingSolver solver_;
  Solution solution_;
};

TEST_F(LyingSolverTest, TheTruthPasses) {
  for (int seed = 0; seed < kSeeds; ++seed) {
    const StepProblem problem = make_small_problem(seed);
    const SolveSummary summary = solve(problem);
    EXPECT_TRUE(is_exact(problem, summary, solution_)) << "seed " << seed;
    EXPECT_TRUE(is_honest(problem, summary, solution_)) << "seed " << seed;
  }
}

TEST_F(LyingSolverTest, OneWrongImpulseIsCaught) {
  for (int seed = 0; seed < kSeeds; ++seed) {
    const StepProblem problem = make_small_problem(seed, {.mass_ratio = 10});
    SeededRandom random(seed);
    const int row = random.integer(0, problem.row_count() - 1);
    solver_.damage_solution = [row](Solution& solution) { solution.impulse[row] += 1e-6; };
    const SolveSummary summary = solve(problem);
    EXPECT_FALSE(is_exact(problem, summary, solution_)) << "seed " << seed << " row " << row;
    EXPECT_FALSE(is_honest(problem, summary, solution_)) << "seed " << seed << " row " << row;
  }
}

TEST_F(LyingSolverTest, OneWrongRowInTheSolversCopyIsCaught) {
  int caught = 0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const StepProblem problem = make_small_problem(seed, {.mass_ratio = 10});
    const std::vector<double> truth = solve_by_enumeration(problem).impulse;
    int row = 0;  // one that is free: at a bound a small change of w changes nothing
    while (row < problem.row_count() &&
           (truth[row] == problem.lower[row] || truth[row] == problem.upper[row]))
      ++row;
    if (row == problem.row_count()) continue;
    solver_.damage_problem = [row](StepProblem& copy) { copy.rhs[row] += 1e-6; };
    EXPECT_FALSE(is_exact(problem, solve(problem), solution_)) << "seed " << seed << " row " << row;
    ++caught;
  }
  EXPECT_GE(caught, kSeeds / 2);
}

TEST_F(LyingSolverTest, AVelocityThatIsNotOfTheImpulsesIsCaught) {
  solver_.damage_solution = [](Solution& solution) { solution.velocity.back() += 1e-6; };
  const StepProblem problem = make_small_problem(1);
  EXPECT_FALSE(is_exact(problem, solve(problem), solution_));
  solver_.damage_solution = [](Solution& solution) { solution.velocity.back() = std::nan(""); };
  EXPECT_FALSE(is_exact(problem, solve(problem), solution_));
  solver_.damage_solution = [](Solution& solution) { solution.velocity.pop_back(); };
  EXPECT_FALSE(is_exact(problem, solve(problem), solution_));
}

TEST_F(LyingSolverTest, NanImpulsesAreCaught) {
  solver_.damage_solution = [](Solution& solution) { solution.impulse.back() = std::nan(""); };
  const StepProblem problem = make_small_problem(1);
  EXPECT_FALSE(is_exact(problem, solve(problem), solution_));
}

TEST_F(LyingSolverTest, FalseModestyIsCaught) {
  solver_.status = SolveStatus::not_converged;
  const StepProblem problem = make_small_problem(1);
  EXPECT_FALSE(is_honest(problem, solve(problem), solution_));
}

TEST(SameBytesTest, TellsZerosApart) {
  EXPECT_TRUE(same_bytes(std::vector<double>{1, 2}, std::vector<double>{1, 2}));
  EXPECT_FALSE(same_bytes(std::vector<double>{0.0}, std::vector<double>{-0.0}));
  EXPECT_FALSE(same_bytes(std::vector<double>{1}, std::vector<double>{1, 1}));
}

}  // namespace
}  // namespace cleave
