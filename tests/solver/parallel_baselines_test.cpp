// Baselines that iterate on all threads: apgd, jacobi-split, pgs-parts, split-domains.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "solver/registry.h"
#include "tests/solver/allocation_counter.h"
#include "tests/solver/iterative_checks.h"
#include "tests/solver/problem_makers.h"
#include "tests/solver/solver_checks.h"

namespace cleave {
namespace {

class ParallelBaselineTest : public testing::TestWithParam<std::string> {
 protected:
  static std::string with_sweeps(int sweeps) { return GetParam() + "@sweeps=" + std::to_string(sweeps); }
};

// Bilateral rows, one-sided and boxed ones, equal bounds, friction boxes and copies of rows.
TEST_P(ParallelBaselineTest, SmallProblemsComeToTheOracle) {
  for (int seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const StepProblem problem =
        make_small_problem(seed, {.least_cfm = 1e-3, .most_cfm = 1e-1, .mass_ratio = 10});
    const Iterated found = iterate_by(with_sweeps(20000), problem, std::min(2, problem.body_count()));
    const Iterated oracle = iterate_by("dense", problem);
    EXPECT_LE(judge(problem, found.solution.impulse).residual_m_per_s, 1e-6);
    EXPECT_TRUE(velocities_agree(problem, found.solution.velocity, oracle.solution.velocity, 1e-4));
  }
}

TEST_P(ParallelBaselineTest, APileComesToTheOracle) {
  const StepProblem problem = make_pile(1, {.columns = 2, .rows = 2, .layers = 2, .cfm = 1e-3});
  const Iterated found = iterate_by(with_sweeps(10000), problem, 3), oracle = iterate_by("dense", problem);
  EXPECT_LE(judge(problem, found.solution.impulse).residual_m_per_s, 1e-6);
  EXPECT_TRUE(velocities_agree(problem, found.solution.velocity, oracle.solution.velocity, 1e-5));
}

// Large enough for several chunks of rows and of bodies.
TEST_P(ParallelBaselineTest, AnyNumberOfThreadsGivesTheSameBytes) {
  const StepProblem problem = make_pile(3, {.columns = 5, .rows = 5, .layers = 4, .mass_ratio = 100});
  ASSERT_GE(problem.body_count(), 96);
  const Iterated one = iterate_by(with_sweeps(20), problem, 5);
  EXPECT_EQ(one.summary.iterations, 20);
  for (const int threads : {2, 3, 7}) {
    const Iterated more = iterate_by(with_sweeps(20), problem, 5, threads);
    EXPECT_TRUE(same_bytes(more.solution.impulse, one.solution.impulse)) << threads << " threads";
    EXPECT_TRUE(same_bytes(more.solution.velocity, one.solution.velocity)) << threads << " threads";
    EXPECT_EQ(more.summary.iterations, 20);
  }
}

TEST_P(ParallelBaselineTest, SweepsAsOftenAsAskedFor) {
  const StepProblem problem = make_pile(13, {.columns = 3, .rows = 2, .layers = 3, .cfm = 1e-8});
  for (const int sweeps : {0, 1, 7}) {
    const Iterated found = iterate_by(with_sweeps(sweeps), problem, 2);
    EXPECT_EQ(found.summary.iterations, sweeps);
    EXPECT_EQ(found.summary.status, SolveStatus::not_converged);
    EXPECT_EQ(found.summary.strategy, GetParam());
  }
}

// A row of zeros constrains nothing, whatever its bounds.
TEST_P(ParallelBaselineTest, ARowOfZerosMovesNothing) {
  StepProblem problem = make_small_problem(4, {.least_cfm = 1e-2, .most_cfm = 1e-1, .mass_ratio = 10});
  const Iterated without = iterate_by(with_sweeps(2000), problem);
  RowSpec zeros;
  zeros.lower = -1, zeros.upper = 2;
  append_row(problem, zeros);
  const Iterated with = iterate_by(with_sweeps(2000), problem);
  EXPECT_TRUE(velocities_agree(problem, with.solution.velocity, without.solution.velocity, 1e-7));
  EXPECT_EQ(with.solution.impulse.back(), 0);
}

TEST_P(ParallelBaselineTest, SecondSolveAllocatesNothing) {
  const StepProblem problem = make_pile(5, {.columns = 5, .rows = 4, .layers = 3, .cfm = 1e3});
  const std::vector<int> parts = sliced_parts(problem.body_count(), 4);
  for (const int threads : {1, 2}) {
    const auto solver = make_step_solver(with_sweeps(1000), {.threads = threads});
    Solution solution = cold_start(problem);
    ASSERT_TRUE(is_exact(problem, solver->solve(problem, parts, solution), solution));
    std::ranges::fill(solution.impulse, 0.0);
    const AllocationCount allocations;
    const SolveSummary summary = solver->solve(problem, parts, solution);
    const long count = allocations.count();
    EXPECT_EQ(count, 0) << threads << " threads";
    EXPECT_TRUE(is_exact(problem, summary, solution));
  }
}

INSTANTIATE_TEST_SUITE_P(Baselines, ParallelBaselineTest,
                         testing::Values("apgd", "jacobi-split", "pgs-parts", "split-domains"),
                         [](const auto& info) {
                           std::string name = info.param;
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

TEST(ApgdTest, MoreIterationsNeverLeaveMore) {
  const StepProblem problem = make_pile(2, {.columns = 2, .rows = 2, .layers = 3, .mass_ratio = 100});
  double last = judge(problem, cold_start(problem).impulse).residual_m_per_s;
  const double first = last;
  for (const int sweeps : {1, 2, 3, 5, 8, 13, 21, 34, 55, 89, 144, 1000}) {
    const Iterated found = iterate_by("apgd@sweeps=" + std::to_string(sweeps), problem);
    const double residual = judge(problem, found.solution.impulse).residual_m_per_s;
    EXPECT_LE(residual, last * (1 + 1e-9)) << sweeps << " iterations";
    last = residual;
  }
  EXPECT_LT(last, 0.01 * first);
}

TEST(ApgdTest, EndsWhereNothingIsANumber) {
  const StepProblem problem = make_pile(1, {.columns = 2, .rows = 2, .layers = 2});
  const std::size_t rows = static_cast<std::size_t>(problem.row_count());
  Solution solution{std::vector<double>(rows, std::numeric_limits<double>::quiet_NaN()), {}};
  const auto solver = make_step_solver("apgd@sweeps=5", {});
  EXPECT_NE(solver->solve(problem, sliced_parts(problem.body_count(), 1), solution).status, SolveStatus::ok);
}

TEST(ApgdTest, EndsWhereTheTargetIsMet) {
  const StepProblem problem = make_pile(5, {.columns = 2, .rows = 2, .layers = 2, .cfm = 1e3});
  const Iterated found = iterate_by("apgd@sweeps=100000", problem);
  EXPECT_EQ(found.summary.status, SolveStatus::ok);
  EXPECT_LT(found.summary.iterations, 1000);
  EXPECT_LE(judge(problem, found.solution.impulse).residual_m_per_s, 1e-10);
}

// Acceleration is what it is for: on a stack that takes plain descent long, far fewer iterations than the
// slowest of Jacobi's kind need sweeps.
TEST(ApgdTest, IsFasterThanSweepsThatAreNotAccelerated) {
  const StepProblem problem = make_pile(6, {.columns = 1, .rows = 1, .layers = 12, .mu = 0});
  const auto residual = [&](const std::string& solver) {
    return judge(problem, iterate_by(solver, problem).solution.impulse).residual_m_per_s;
  };
  EXPECT_LT(residual("apgd@sweeps=400"), 0.1 * residual("jacobi-split@sweeps=400"));
}

}  // namespace
}  // namespace cleave
