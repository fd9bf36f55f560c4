// Solvers that carry their factor from step to step: exact on every step, whatever the factor was of, and it
// serves where little has changed.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "solver/carried_factor.h"
#include "solver/direct_solver.h"
#include "solver/registry.h"
#include "tests/solver/dear_kernel.h"
#include "tests/solver/problem_makers.h"
#include "tests/solver/seeded_random.h"
#include "tests/solver/solver_checks.h"

namespace cleave {
namespace {

constexpr PileOptions kPile{.columns = 3, .rows = 3, .layers = 3};

// The next step of the same bodies: rows turned and loads changed by so much, from the solution before.
StepProblem moved(StepProblem problem, const Solution& before, double by, SeededRandom& random) {
  for (double& value : problem.jacobian) value *= 1 + by * random.uniform(-1, 1);
  for (double& value : problem.free_velocity) value += by * random.uniform(-1, 1);
  problem.warm_impulse = before.impulse;
  return problem;
}

struct Totals {
  int factorizations = 0, factor_reuses = 0, cg_iterations = 0;
  std::vector<double> velocities;  // of all steps
};

// Every step is judged and compared with a solver that has no history.
Totals solve_steps(const std::string& solver, const StepProblem& first, double by, int threads) {
  const auto used = make_step_solver(solver, {.threads = threads, .session = true});
  const std::vector<int> parts = sliced_parts(first.body_count(), 4);
  SeededRandom random(5);
  Totals totals;
  Solution solution = cold_start(first);
  for (int step = 0; step < 6; ++step) {
    const StepProblem problem = step == 0 ? first : moved(first, solution, by, random);
    solution.impulse = problem.warm_impulse;
    const SolveSummary summary = used->solve(problem, parts, solution);
    EXPECT_TRUE(is_exact(problem, summary, solution)) << solver << ", step " << step;
    Solution fresh = cold_start(problem);
    EXPECT_TRUE(is_exact(problem, make_step_solver(solver, {})->solve(problem, parts, fresh), fresh));
    EXPECT_TRUE(velocities_agree(problem, solution.velocity, fresh.velocity, 1e-9))
        << solver << ", step " << step;
    totals.factorizations += summary.factorizations;
    totals.factor_reuses += summary.factor_reuses;
    totals.cg_iterations += summary.cg_iterations;
    totals.velocities.insert(totals.velocities.end(), solution.velocity.begin(), solution.velocity.end());
  }
  return totals;
}

class SessionTest : public testing::TestWithParam<const char*> {};

TEST_P(SessionTest, AgreesWithSolversWithoutHistory) {
  for (const char* strategy : {"pivot", "interior-point"})
    for (const double by : {1e-9, 1e-3, 0.3})
      solve_steps(std::string(strategy) + ":" + GetParam(), make_pile(7, kPile), by, 1);
}

TEST_P(SessionTest, ThreadsDoNotChangeIt) {
  const std::string solver = std::string("pivot:") + GetParam();
  const StepProblem chain = make_chain(3, {.links = 60});
  const Totals one = solve_steps(solver, chain, 1e-6, 1);
  for (const int threads : {2, 3})
    EXPECT_EQ(solve_steps(solver, chain, 1e-6, threads).velocities, one.velocities);
}

INSTANTIATE_TEST_SUITE_P(Kernels, SessionTest,
                         testing::Values("monolithic", "schur-rows", "schur-bodies", "schur-nested"),
                         [](const auto& info) {
                           std::string name = info.param;
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

// Largest component of H dv - (f_v + J^T D f_r).
double defect(const PreparedStep& step, const std::vector<double>& d, const std::vector<double>& f_v,
              const std::vector<double>& f_r, const std::vector<double>& dv) {
  std::vector<double> rows(f_r.size()), left(f_v.size());
  step.jacobian_times(dv, rows);
  for (std::size_t r = 0; r < rows.size(); ++r) rows[r] = d[r] * (rows[r] - f_r[r]);
  step.add_jacobian_transpose(rows, left);
  double worst = 0;
  for (int body = 0; body < step.body_count(); ++body) {
    for (int i = 0; i < 6; ++i) {
      double sum = left[6 * body + i] - f_v[6 * body + i];
      for (int k = 0; k < 6; ++k) sum += step.problem().mass[36 * body + 6 * i + k] * dv[6 * body + k];
      worst = std::max(worst, std::abs(sum));
    }
  }
  return worst;
}

class CarriedFactorTest : public testing::Test {
 protected:
  CarriedFactorTest() : problem_(make_pile(3, kPile)), tasks_(clock_, 1) {
    step_.prepare(problem_);
    d_.assign(problem_.row_count(), 1.0);
    f_r_.assign(problem_.row_count(), 0.5);
    f_v_.assign(6 * problem_.body_count(), 1.0);
    dv_ = f_v_;
    dlambda_ = f_r_;
  }
  // Factors, goes to the next step, and takes the factor along.
  void carry(CarriedFactor& carried, double weight_then) {
    carried.begin_step(0);
    carried.analyze(step_, parts_, tasks_);
    EXPECT_TRUE(carried.factor(d_, tasks_));
    carried.begin_step(0);
    EXPECT_TRUE(carried.rebind(step_, parts_, tasks_));
    d_.assign(d_.size(), weight_then);
    EXPECT_TRUE(carried.factor(d_, tasks_));
    EXPECT_EQ(carried.counts().factorizations, 0) << "not carried";
  }
  CarriedFactor::Counts solve_carried(std::unique_ptr<Kernel> kernel, double weight_then) {
    CarriedFactor carried(std::move(kernel));
    carry(carried, weight_then);
    carried.solve(f_v_, f_r_, dv_, dlambda_, tasks_);
    return carried.counts();
  }

  StepProblem problem_;
  const std::vector<int> parts_ = single_part(problem_.body_count());
  StageClock clock_;
  ParallelTasks tasks_;
  PreparedStep step_;
  std::vector<double> d_, f_v_, f_r_, dv_, dlambda_;
};

TEST_F(CarriedFactorTest, SolvesTheSystemOfTheStepAtHand) {
  const auto counts = solve_carried(std::make_unique<Dear>(), 1.5);
  EXPECT_EQ(counts.factorizations, 0);
  EXPECT_EQ(counts.factor_reuses, 1);
  EXPECT_GT(counts.cg_iterations, 1);
  EXPECT_LT(defect(step_, d_, f_v_, f_r_, dv_), 1e-5);
}

// That no factor is positive definite shows at once. One that is, of another matrix, leads to the answer too,
// only slowly: it is made anew where so many iterations are above what a factorisation takes.
TEST_F(CarriedFactorTest, IsMadeAnewWhereItIsWrong) {
  constexpr double kDear = 1e3, kOfFewIterations = 5;  // Mflop
  for (const auto& [planted, mflop] : {std::pair(-1.0, kDear),
                                       {0.0, kDear},
                                       {std::numeric_limits<double>::infinity(), kDear},
                                       {1.0, kOfFewIterations}}) {
    const auto counts =
        solve_carried(std::make_unique<Dear>(planted, make_monolithic_kernel(Settings()), mflop), 1.5);
    EXPECT_EQ(counts.factorizations, 1) << planted;
    EXPECT_EQ(counts.cg_iterations > 0, planted == 1) << planted;
    EXPECT_LT(defect(step_, d_, f_v_, f_r_, dv_), 1e-9) << planted;
  }
}

TEST_F(CarriedFactorTest, OfAnotherMatrixServesWhereTheOwnOneIsDear) {
  const auto right = solve_carried(std::make_unique<Dear>(), 1.5);
  const auto wrong = solve_carried(std::make_unique<Dear>(1.0), 1.5);
  EXPECT_EQ(wrong.factorizations, 0);
  EXPECT_GT(wrong.cg_iterations, 2 * right.cg_iterations);
  EXPECT_LT(defect(step_, d_, f_v_, f_r_, dv_), 1e-5);
}

// A factor that is no positive definite one when it is to serve on, and cannot be made anew.
class Unfactorable : public Dear {
 public:
  Unfactorable() : Dear(-1.0) {}
  bool factor(const RowWeights& weights, ParallelTasks& tasks, const RowWork& before) override {
    return factorizations_++ == 0 && Dear::factor(weights, tasks, before);
  }

 private:
  int factorizations_ = 0;
};

// What is left of a factorisation that failed hangs on which of its tasks ran: nothing is made of it.
TEST_F(CarriedFactorTest, LeavesNoIncrementWhereItCannotBeMadeAnew) {
  CarriedFactor carried(std::make_unique<Unfactorable>());
  carry(carried, d_[0]);
  for (int solve = 0; solve < 2; ++solve) {
    carried.solve(f_v_, f_r_, dv_, dlambda_, tasks_);
    EXPECT_EQ(dv_, std::vector<double>(dv_.size(), 0.0));
    EXPECT_EQ(carried.counts().cg_iterations, 0);
  }
}

// Pivots, and ends above the limit where it had a carried factor alone, as one would that is wrong in a way
// which conjugate gradients do not tell.
class SpoiltByCarriedFactor : public Strategy {
 public:
  explicit SpoiltByCarriedFactor(int& spoilt) : spoilt_(spoilt) {}
  bool run(SolveState& state) override {
    const bool solved = pivot_->run(state);
    const CarriedFactor::Counts& counts = dynamic_cast<CarriedFactor&>(*state.kernel).counts();
    if (counts.factor_reuses == 0 || counts.factorizations > 0) return solved;
    for (double& impulse : state.impulse) impulse += 1;
    state.update_velocity();
    ++spoilt_;
    return false;
  }

 private:
  std::unique_ptr<Strategy> pivot_ = make_pivot(Settings());
  int& spoilt_;
};

// Under the name of a strategy that hands over to no other.
TEST(SessionFactorTest, IsMadeAnewWhereItsAnswerIsAboveTheLimit) {
  int spoilt = 0, seen = 0;
  const auto solver = make_direct_solver("interior-point", "monolithic", {.session = true}, Settings(),
                                         std::make_unique<SpoiltByCarriedFactor>(spoilt));
  const StepProblem first = make_chain(3, {.links = 200, .extra_joints = 2000});  // dear to factor
  const std::vector<int> parts = single_part(first.body_count());
  SeededRandom random(5);
  Solution solution = cold_start(first);
  for (int step = 0; step < 6; ++step) {
    const StepProblem problem = step == 0 ? first : moved(first, solution, 1e-9, random);
    solution.impulse = problem.warm_impulse;
    const SolveSummary summary = solver->solve(problem, parts, solution);
    EXPECT_TRUE(is_exact(problem, summary, solution)) << "step " << step;
    EXPECT_EQ(summary.fallbacks, spoilt - seen) << "step " << step;
    EXPECT_TRUE(spoilt == seen || summary.factorizations > 0) << "step " << step;
    seen = spoilt;
  }
  EXPECT_GE(spoilt, 3);
}

// Factors, but for the step of which only rows are given; and from then on anew.
class FactorsLate : public Strategy {
 public:
  bool run(SolveState& state) override {
    if (++steps_ == 2) return true;
    if (steps_ > 2) dynamic_cast<CarriedFactor&>(*state.kernel).forget();
    return state.factor_free();
  }

 private:
  int steps_ = 0;
};

// Pairs of bodies of the second step have no place in the first one's pattern, so that the third one is
// analysed.
TEST(SessionPartsTest, AreThoseOfTheStepAtHand) {
  const StepProblem first = make_chain(3, {.links = 60}),
                    later = make_chain(4, {.links = 60, .extra_joints = 20});
  const auto solver = make_direct_solver("pivot", "schur-bodies", {.session = true}, Settings(),
                                         std::make_unique<FactorsLate>());
  const std::vector<int> parts = sliced_parts(60, 4);
  ASSERT_EQ(first.body_count(), 60);
  Solution solution = cold_start(first);
  solver->solve(first, parts, solution);
  {
    std::vector<int> gone = parts;  // the caller's, who does with it what he likes
    solution = cold_start(later);
    solver->solve(later, gone, solution);
    std::ranges::fill(gone, 0);
  }
  const SolveSummary carried = solver->solve(later, parts, solution);
  Solution fresh = cold_start(later);
  const SolveSummary alone = make_step_solver("pivot:schur-bodies")->solve(later, parts, fresh);
  EXPECT_GT(alone.interface_unknowns, 0);
  EXPECT_EQ(carried.interface_unknowns, alone.interface_unknowns);
}

}  // namespace
}  // namespace cleave
