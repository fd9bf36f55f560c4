// Parts in a tree: what stands between them stands there at every level, and the kernel on it solves like any
// other, on any number of threads, whatever order the tasks come in.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/registry.h"
#include "solver/separators.h"
#include "solver/worker_team.h"
#include "tests/solver/part_trees.h"
#include "tests/solver/problem_makers.h"

namespace cleave {
namespace {

StepProblem pile(double cfm = 1e-5, int columns = 10) {
  PileOptions options;
  options.columns = columns;
  options.cfm = cfm;
  return make_pile(3, options);
}

// Node of a body, or a node below it: whether `above` is on the way from `node` to the root.
bool is_above(const std::vector<int>& parent, int node, int above) {
  while (node >= 0 && node != above) node = parent[node];
  return node == above;
}

TEST(SeparatorsTest, StandBetweenAllThatIsCut) {
  const StepProblem problem = pile();
  PreparedStep step;
  step.prepare(problem);
  for (const int leaves : {1, 2, 3, 7, 16}) {
    const PartTree tree = sliced_tree(problem.body_count(), leaves);
    Separators separators;
    separators.find(step, tree.parts());
    EXPECT_EQ(separators.part_count(), leaves);
    const auto node = separators.node_of_body();
    for (const RowGroup& group : step.groups()) {
      if (group.body_b < 0) continue;
      const int a = node[group.body_a], b = node[group.body_b];
      EXPECT_TRUE(is_above(tree.parent_of_part, a, b) || is_above(tree.parent_of_part, b, a))
          << a << " and " << b;
    }
    for (int body = 0; body < problem.body_count(); ++body)
      EXPECT_TRUE(is_above(tree.parent_of_part, tree.part_of_body[body], node[body]));
    EXPECT_LT(*std::ranges::max_element(node), static_cast<int>(tree.parent_of_part.size()));
  }
}

Solution solved(const std::string& solver, const StepProblem& problem, const Parts& parts, int threads = 1) {
  SolveOptions options;
  options.threads = threads;
  Solution solution;
  const SolveSummary summary = make_step_solver(solver, options)->solve(problem, parts, solution);
  EXPECT_EQ(summary.status, SolveStatus::ok) << solver << ": " << summary.message;
  return solution;
}

TEST(SchurNestedTest, AgreesWithTheWholeSystemOnAnyTree) {
  for (const double cfm : {1e-5, 1e-9}) {
    const StepProblem problem = pile(cfm);
    const Solution whole = solved("exact", problem, {});
    for (const int leaves : {1, 2, 5, 16}) {
      const PartTree tree = sliced_tree(problem.body_count(), leaves);
      for (const char* solver : {"pivot:schur-nested", "interior-point:schur-nested"}) {
        const Solution nested = solved(solver, problem, tree.parts());
        for (std::size_t c = 0; c < whole.velocity.size(); ++c)
          ASSERT_NEAR(nested.velocity[c], whole.velocity[c], 1e-9) << solver << ", " << leaves << " leaves";
      }
    }
  }
}

TEST(SchurNestedTest, OneLevelIsSchurBodies) {
  const StepProblem problem = pile();
  const std::vector<int> parts = sliced_parts(problem.body_count(), 6);
  const Solution bodies = solved("pivot:schur-bodies", problem, parts);
  EXPECT_EQ(solved("pivot:schur-nested", problem, parts).impulse, bodies.impulse);
  std::vector<int> star(7, 6);
  star.back() = -1;
  EXPECT_EQ(solved("pivot:schur-nested", problem, Parts(parts, star)).impulse, bodies.impulse);
}

TEST(KernelsTest, GiveTheSameBytesOnAnyNumberOfThreadsInAnyOrder) {
  const StepProblem problem = pile(1e-5, 6);
  const PartTree tree = sliced_tree(problem.body_count(), 9);
  for (const char* solver :
       {"exact", "schur", "interior-point:schur-rows", "pivot:schur-bodies", "interior-point:schur-nested"}) {
    const Solution one = solved(solver, problem, tree.parts());
    for (const auto& [threads, seed] : {std::pair(1, 1), {2, 0}, {3, 2}, {7, 3}}) {  // 0: not shuffled
      WorkerTeam::shared(threads).shuffle(seed);
      const Solution many = solved(solver, problem, tree.parts(), threads);
      WorkerTeam::shared(threads).shuffle(0);
      EXPECT_EQ(many.impulse, one.impulse) << solver << ", " << threads << " threads, seed " << seed;
      EXPECT_EQ(many.velocity, one.velocity) << solver << ", " << threads << " threads, seed " << seed;
    }
  }
}

}  // namespace
}  // namespace cleave
