// Parts in a tree, on two threads: what is large enough for slabs and for fronts in tiles allocates in its
// first solve alone, and so does a session that serves several steps with one factor.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>

#include "solver/registry.h"
#include "solver/step_solver.h"
#include "tests/solver/allocation_counter.h"
#include "tests/solver/part_trees.h"
#include "tests/solver/problem_makers.h"
#include "tests/solver/solver_checks.h"
#include "tests/solver/task_shapes.h"

namespace cleave {
namespace {

constexpr int kThreads = 2;

struct Counted {
  SolveSummary summary;
  long allocations = -1;
};

Counted solve_and_count(StepSolver& solver, const StepProblem& problem, const Parts& parts,
                        Solution& solution) {
  Counted counted;
  const AllocationCount allocations;
  counted.summary = solver.solve(problem, parts, solution);
  counted.allocations = allocations.count();
  return counted;
}

TEST(AllocationOfTreesTest, SecondSolveOfALargePileAllocatesNothing) {
  const StepProblem problem = make_pile(11, {.columns = 7, .rows = 7, .layers = 7, .cfm = 1e-3});
  const PartTree tree = sliced_tree(problem.body_count(), 8);
  ASSERT_GE(count_slabs(problem), 3);
  ASSERT_TRUE(has_tiled_front(problem, tree.parts()));
  for (const char* name : {"pivot:schur-nested", "interior-point:schur-nested"}) {
    SCOPED_TRACE(name);
    const auto solver = make_step_solver(name + std::string("@reuse-analysis=true"), {.threads = kThreads});
    Solution solution = cold_start(problem);
    ASSERT_TRUE(is_exact(problem, solver->solve(problem, tree.parts(), solution), solution));
    std::ranges::fill(solution.impulse, 0.0);
    const Counted counted = solve_and_count(*solver, problem, tree.parts(), solution);
    EXPECT_EQ(counted.allocations, 0);
    EXPECT_TRUE(is_exact(problem, counted.summary, solution));
  }
}

// The next step of the same bodies: rows turned and loads changed by a little.
void move_on(StepProblem& problem, SeededRandom& random) {
  constexpr double kBy = 1e-9;
  for (double& value : problem.jacobian) value *= 1 + kBy * random.uniform(-1, 1);
  for (double& value : problem.free_velocity) value += kBy * random.uniform(-1, 1);
}

// The first step factors, the second one makes room for what conjugate gradients need.
TEST(AllocationOfTreesTest, AStepWithACarriedFactorAllocatesNothing) {
  StepProblem problem = make_chain(3, {.links = 200, .extra_joints = 2000});  // dear to factor
  const PartTree tree = sliced_tree(problem.body_count(), 4);
  ASSERT_TRUE(has_tiled_front(problem, tree.parts()));
  const auto solver = make_step_solver("pivot:schur-nested", {.threads = kThreads, .session = true});
  SeededRandom random(5);
  Solution solution = cold_start(problem);
  for (int step = 0; step < 4; ++step) {
    SCOPED_TRACE("step " + std::to_string(step));
    if (step > 0) move_on(problem, random);
    const Counted counted = solve_and_count(*solver, problem, tree.parts(), solution);
    EXPECT_TRUE(is_exact(problem, counted.summary, solution));
    EXPECT_EQ(counted.summary.factorizations > 0, step == 0);
    EXPECT_EQ(counted.summary.factor_reuses > 0, step > 0);
    EXPECT_EQ(counted.summary.cg_iterations > 0, step > 0);
    if (step >= 2) {
      EXPECT_EQ(counted.allocations, 0);
    }
  }
}

}  // namespace
}  // namespace cleave
