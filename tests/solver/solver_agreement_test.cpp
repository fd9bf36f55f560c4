// All direct solvers find the same velocities on problems with the structure of piles, towers and chains.
#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "solver/linear/dense_tiles.h"
#include "solver/registry.h"
#include "solver/step_solver.h"
#include "tests/solver/problem_makers.h"
#include "tests/solver/solver_checks.h"

namespace cleave {
namespace {

constexpr double kTolerance = 1e-8;
constexpr int kDenseMostRows = 600;  // more would be slow

struct Case {
  std::string name;
  StepProblem problem;
  int parts;
};

std::string name_case(const char* shape, double cfm) {
  return shape + (" cfm 1e" + std::to_string(static_cast<int>(std::lround(std::log10(cfm)))));
}

// Size 1 for every solver of the registry; larger ones for the solvers of the experiment.
std::vector<Case> make_cases(int size, double cfm) {
  std::vector<Case> cases;
  const auto add = [&cases, cfm](const char* shape, StepProblem problem, int parts) {
    cases.push_back({name_case(shape, cfm), std::move(problem), parts});
  };
  add("tower", make_pile(1, {.columns = 1, .rows = 1, .layers = 6 * size, .cfm = cfm}), 3);
  add("bricks", make_pile(2, {.columns = 1 + size, .rows = 2, .layers = 2, .cfm = cfm, .mass_ratio = 100}),
      2);
  add("smooth", make_pile(3, {.columns = 1 + size, .rows = 2, .layers = 3, .cfm = cfm, .mu = 0}), 3);
  add("chain", make_chain(4, {.links = 20 * size, .extra_joints = 4 * size, .cfm = cfm}), 4);
  add("ring", make_chain(5, {.links = 20 * size, .hinges = true, .closed = true, .cfm = cfm}), 3);
  add("bob", make_chain(6, {.links = 25 * size, .doubled = true, .cfm = cfm, .bob_mass_kg = 1e4}), 4);
  return cases;
}

void expect_agreement(const Case& c, const std::vector<std::string>& solvers) {
  SCOPED_TRACE(c.name + ", " + std::to_string(c.problem.row_count()) + " rows");
  const std::vector<int> slices = sliced_parts(c.problem.body_count(), c.parts);
  Solution reference = cold_start(c.problem);
  const SolveSummary summary = make_step_solver("monolithic", {})->solve(c.problem, slices, reference);
  ASSERT_TRUE(is_exact(c.problem, summary, reference));
  int compared = 0;
  for (const std::string& name : solvers) {
    if (may_miss(name) || (kernel_of(name) == "dense" && c.problem.row_count() > kDenseMostRows)) continue;
    SCOPED_TRACE(name);
    Solution solution = cold_start(c.problem);
    EXPECT_TRUE(
        is_exact(c.problem, make_step_solver(name, {})->solve(c.problem, slices, solution), solution));
    EXPECT_TRUE(velocities_agree(c.problem, solution.velocity, reference.velocity, kTolerance));
    ++compared;
  }
  EXPECT_GE(compared, solvers.size() > 2 ? 6 : 1);
}

TEST(SolverAgreementTest, AllExactSolversFindTheSameVelocities) {
  for (const Case& c : make_cases(1, 1e-5)) expect_agreement(c, all_solver_names());
}

TEST(SolverAgreementTest, DenseMonolithicAndSchurAgreeAtAllStiffnesses) {
  for (const double cfm : {1e-4, 1e-5, 1e-6, 1e-7}) {
    for (const Case& c : make_cases(2, cfm)) expect_agreement(c, {"dense", "schur"});
  }
}

TEST(SolverAgreementTest, MonolithicAndSchurAgreeOnLargePiles) {
  const StepProblem heavy = make_pile(7, {.columns = 4, .rows = 3, .layers = 4, .mass_ratio = 1000});
  const StepProblem smooth = make_pile(8, {.columns = 5, .rows = 5, .layers = 8, .mu = 0});
  expect_agreement({"mass ratio 1000", heavy, 4}, {"schur"});
  expect_agreement({"200 bodies", smooth, 8}, {"schur"});
}

TEST(SolverAgreementTest, SchurIsExactOnScatteredParts) {
  const StepProblem pile = make_pile(9, {.columns = 3, .rows = 3, .layers = 3, .mass_ratio = 10});
  const StepProblem chain = make_chain(9, {.links = 40, .extra_joints = 10, .closed = true});
  for (const StepProblem& problem : {pile, chain}) {
    const int bodies = problem.body_count();
    SeededRandom random(9);
    Solution reference = cold_start(problem);
    ASSERT_TRUE(is_exact(problem,
                         make_step_solver("monolithic", {})->solve(problem, single_part(bodies), reference),
                         reference));
    for (const std::vector<int>& parts :
         {own_parts(bodies), random_parts(random, bodies, 6), single_part(bodies)}) {
      Solution solution = cold_start(problem);
      EXPECT_TRUE(
          is_exact(problem, make_step_solver("schur", {})->solve(problem, parts, solution), solution));
      EXPECT_TRUE(velocities_agree(problem, solution.velocity, reference.velocity, kTolerance));
    }
  }
}

// Large enough for several tiles of the interface system.
TEST(SolverAgreementTest, SchurOnTwoThreadsGivesTheBytesOfOne) {
  const StepProblem problem = make_pile(10, {.columns = 3, .rows = 3, .layers = 3});
  const std::vector<int> parts = sliced_parts(problem.body_count(), 5);
  Solution one = cold_start(problem), two = cold_start(problem);
  make_step_solver("schur", {.threads = 1})->solve(problem, parts, one);
  make_step_solver("schur", {.threads = 2})->solve(problem, parts, two);
  EXPECT_TRUE(same_bytes(one.impulse, two.impulse));
  EXPECT_TRUE(same_bytes(one.velocity, two.velocity));
}

// Threads are those of SolveOptions: what the environment grants to OpenMP changes nothing.
TEST(SolverAgreementTest, LibraryThreadsDoNotChangeTheBytes) {
  const StepProblem problem = make_pile(10, {.columns = 3, .rows = 3, .layers = 2});
  const std::vector<int> parts = sliced_parts(problem.body_count(), 4);
  const int openmp_threads = omp_get_max_threads();
  for (const char* name : {"dense", "monolithic", "schur"}) {
    Solution solutions[2] = {cold_start(problem), cold_start(problem)};
    for (int k = 0; k < 2; ++k) {
      omp_set_num_threads(k + 1);
      make_step_solver(name, {})->solve(problem, parts, solutions[k]);
    }
    EXPECT_TRUE(same_bytes(solutions[0].impulse, solutions[1].impulse)) << name;
  }
  omp_set_num_threads(openmp_threads);
}

// Where one is missing on this processor, the other is compared with itself.
TEST(SolverAgreementTest, EveryInstructionSetGivesTheSameBytes) {
  const StepProblem problem = make_pile(12, {.columns = 3, .rows = 3, .layers = 3});
  const std::vector<int> parts = sliced_parts(problem.body_count(), 4);
  const DenseTiles& chosen = dense_tiles();
  // At least the set that is chosen.
  ASSERT_GE(std::ranges::count_if(all_dense_tiles(), [](const DenseTiles* t) { return t->is_supported(); }),
            1);
  for (const std::string& name : all_solver_names()) {
    Solution expected = cold_start(problem);
    make_step_solver(name, {.threads = 2})->solve(problem, parts, expected);
    for (const DenseTiles* tiles : all_dense_tiles()) {
      if (!tiles->is_supported()) continue;
      use_dense_tiles(*tiles);
      Solution found = cold_start(problem);
      make_step_solver(name, {.threads = 2})->solve(problem, parts, found);
      EXPECT_TRUE(same_bytes(found.impulse, expected.impulse)) << name << " with " << tiles->name;
    }
    use_dense_tiles(chosen);
  }
}

}  // namespace
}  // namespace cleave
