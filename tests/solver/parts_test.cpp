// Parts as solvers take them: what is a tree of parts and what is none, and what is said of the latter.
#include "solver/parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "solver/registry.h"
#include "tests/solver/allocation_counter.h"
#include "tests/solver/problem_makers.h"
#include "tests/solver/solver_checks.h"

namespace cleave {
namespace {

using Ids = std::vector<int>;

// Straight from the definition, and each rule on its own.
bool is_tree(const Ids& parent) {
  const int nodes = static_cast<int>(parent.size());
  for (int node = 0; node < nodes; ++node) {
    if (parent[node] == -1) continue;
    if (parent[node] >= nodes || parent[node] <= node) return false;
  }
  if (std::ranges::count(parent, -1) != 1) return false;
  const auto is_leaf = [&](int node) { return std::ranges::count(parent, node) == 0; };
  for (int node = 0; node < nodes; ++node)
    for (int earlier = 0; earlier < node; ++earlier)
      if (is_leaf(node) && !is_leaf(earlier)) return false;
  return true;
}

std::string find_error(const Ids& part_of_body, const Ids& parent_of_part, int bodies) {
  return PartsCheck().find_error({part_of_body, parent_of_part}, bodies);
}

// All arrays of up to five nodes, with entries on both sides of what can be one.
TEST(PartsCheckTest, KnowsEverySmallTree) {
  PartsCheck check;
  int trees = 0;
  for (int nodes = 1; nodes <= 5; ++nodes) {
    Ids parent(nodes, -2);
    while (true) {
      const std::string error = check.find_error({Ids{0, 0}, parent}, 2);
      ASSERT_EQ(error.empty(), is_tree(parent)) << testing::PrintToString(parent) << " " << error;
      trees += error.empty();
      int digit = 0;
      while (digit < nodes && parent[digit] == nodes) parent[digit++] = -2;
      if (digit == nodes) break;
      ++parent[digit];
    }
  }
  EXPECT_EQ(trees, 1 + 1 + 2 + 5 + 16);  // of 1 to 5 nodes; up to 4 counted by hand
}

TEST(PartsCheckTest, NamesWhatIsWrong) {
  const Ids four = {0, 1, 1, 2}, tree = {3, 3, 4, 4, -1};
  EXPECT_EQ(find_error(four, tree, 4), "");
  EXPECT_EQ(find_error(four, {}, 4), "");
  EXPECT_EQ(find_error({0, 0}, {-1}, 2), "");
  EXPECT_EQ(find_error({}, {}, 0), "");
  EXPECT_EQ(find_error(four, tree, 5), "part_of_body has 4 entries, needs one per body");
  EXPECT_EQ(find_error(four, {}, 3), "part_of_body has 4 entries, needs one per body");
  EXPECT_EQ(find_error(four, {3, 3, 4, 4, 4}, 4), "parent_of_part[4] = 4, allowed: -1, the root");
  EXPECT_EQ(find_error(four, {3, 3, -1, 4, -1}, 4), "parent_of_part[2] = -1, allowed: 3 to 4, a later node");
  EXPECT_EQ(find_error(four, {3, 3, 4, 5, -1}, 4), "parent_of_part[3] = 5, allowed: 4, a later node");
  EXPECT_EQ(find_error(four, {3, 0, 4, 4, -1}, 4), "parent_of_part[1] = 0, allowed: 2 to 4, a later node");
  EXPECT_EQ(find_error(four, {4, 4, 4, 4, -1, -1}, 4), "parent_of_part[4] = -1, allowed: 5, a later node");
  EXPECT_EQ(find_error(four, {3, 3, 5, 5, 5, -1}, 4),
            "parent_of_part: node 4 has no children and comes after one that has, allowed: leaves before "
            "inner nodes");
  EXPECT_EQ(find_error({0, 1, 3, 2}, tree, 4), "part_of_body[2] = 3, allowed: 0 to 2, a leaf");
  EXPECT_EQ(find_error({0, 1, 1, -1}, tree, 4), "part_of_body[3] = -1, allowed: 0 to 2, a leaf");
  EXPECT_EQ(find_error({1}, {-1}, 1), "part_of_body[0] = 1, allowed: 0, a leaf");
  EXPECT_EQ(find_error({0, 1, 4, 2}, {}, 4), "part_of_body[2] = 4, allowed: 0 to 3");
  EXPECT_EQ(find_error({0, 3, 1, -1}, {}, 4), "part_of_body[3] = -1, allowed: 0 to 3");
}

TEST(PartsCheckTest, AllocatesNothingTheSecondTime) {
  const Ids part_of_body = {0, 1, 1, 2}, parent_of_part = {3, 3, 4, 4, -1};
  PartsCheck check;
  const Parts parts{part_of_body, parent_of_part};
  EXPECT_EQ(check.find_error(parts, 4), "");
  const AllocationCount allocations;
  const bool fine = check.find_error(parts, 4).empty();
  EXPECT_EQ(allocations.count(), 0);
  EXPECT_TRUE(fine);
}

// Whether a solver looks at the tree or at its leaves alone.
TEST(PartsCheckTest, ATreeIsCheckedByEverySolverThatSplits) {
  const StepProblem problem = make_pile(5, {.columns = 2, .rows = 2, .layers = 2, .cfm = 1e-3});
  const Ids leaves = sliced_parts(problem.body_count(), 3);
  const int parts = 1 + *std::ranges::max_element(leaves);
  ASSERT_GE(parts, 2);
  Ids parents(parts, parts);
  parents.push_back(-1);
  Ids broken = parents;
  broken[1] = 0;
  int split = 0;
  for (const std::string& name : all_solver_names()) {
    const auto solver = make_step_solver(name);
    if (!solver->uses_partition()) continue;
    SCOPED_TRACE(name);
    ++split;
    Solution nested = cold_start(problem), refused = nested;
    const SolveSummary solved = solver->solve(problem, {leaves, parents}, nested);
    EXPECT_TRUE(may_miss(name) ? is_honest(problem, solved, nested) : is_exact(problem, solved, nested));
    const SolveSummary summary = solver->solve(problem, {leaves, broken}, refused);
    EXPECT_EQ(summary.status, SolveStatus::refused);
    EXPECT_EQ(summary.message.find("parent_of_part[1] = 0, allowed: "), 0u) << summary.message;
  }
  EXPECT_GE(split, 2);
}

}  // namespace
}  // namespace cleave
