// Branches of the elimination tree: every supernode in one, subtrees only, and nothing that one adds outside
// of itself without its place among the rows below the root.
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "solver/block_symbolic.h"
#include "solver/branch_groups.h"
#include "tests/solver/seeded_random.h"

namespace cleave {
namespace {

using Edges = std::vector<std::pair<int, int>>;

Edges grid(int wide, int deep) {
  Edges edges;
  for (int i = 0; i < wide; ++i)
    for (int k = 0; k < deep; ++k) {
      if (i + 1 < wide) edges.emplace_back(i * deep + k, (i + 1) * deep + k);
      if (k + 1 < deep) edges.emplace_back(i * deep + k, i * deep + k + 1);
    }
  return edges;
}

Edges random_edges(int nodes, int count, int seed) {
  SeededRandom random(seed);
  Edges edges;
  while (static_cast<int>(edges.size()) < count) {
    const int a = random.integer(0, nodes - 1), b = random.integer(0, nodes - 1);
    if (a != b) edges.emplace_back(a, b);
  }
  return edges;
}

void check_branches(const BlockSymbolic& symbolic) {
  const auto branches = symbolic.branches();
  const auto supernodes = symbolic.supernodes();
  int next = 0;
  for (int b = 0; b < static_cast<int>(branches.size()); ++b) {
    const Branch& branch = branches[b];
    ASSERT_EQ(branch.first, next);
    next = branch.last + 1;
    EXPECT_TRUE(branch.first == branch.last || branch.first == supernodes[branch.last].first_descendant);
    EXPECT_TRUE(branch.place >= 0 && branch.place < 1);
    if (branch.parent >= 0) {
      EXPECT_GT(branch.parent, b);
      EXPECT_TRUE(std::ranges::count(symbolic.child_branches(branch.parent), b) == 1);
    }
    const Supernode& root = supernodes[branch.last];
    for (int i = branch.first; i <= branch.last; ++i) {
      const Supernode& s = supernodes[i];
      EXPECT_EQ(s.branch, b);
      EXPECT_EQ(s.stage, branch.stage);
      for (int k = s.first_row + s.width; k < s.first_row + s.row_count; ++k) {
        const int place = symbolic.carry_index()[k];
        if (symbolic.rows()[k] < branch.end_position) {
          EXPECT_EQ(place, -1);
        } else {
          ASSERT_TRUE(place >= 0 && place < root.rows_below());
          EXPECT_EQ(symbolic.rows()[root.first_row + root.width + place], symbolic.rows()[k]);
        }
      }
    }
  }
  EXPECT_EQ(next, static_cast<int>(supernodes.size()));
}

TEST(BranchesTest, HoldEverySupernodeOnce) {
  BlockSymbolic symbolic;
  const Edges wide = grid(60, 20);
  symbolic.analyze(1200, wide);
  check_branches(symbolic);
  EXPECT_GE(symbolic.branches().size(), 30u);
  const Edges small = grid(3, 2);
  symbolic.analyze(6, small);
  check_branches(symbolic);
  EXPECT_EQ(symbolic.branches().size(), 1u);
  symbolic.analyze(0, {});
  EXPECT_TRUE(symbolic.branches().empty());
  for (int seed = 0; seed < 50; ++seed) {
    const Edges edges = random_edges(100, 20 + 10 * seed, seed);
    symbolic.analyze(100, edges);
    check_branches(symbolic);
  }
}

TEST(BranchesTest, KeepStagesApart) {
  const int wide = 40, deep = 10, parts = 4;
  const Edges edges = grid(wide, deep);
  std::vector<int> stage_of_node;  // columns of a grid: parts, and between them columns of the cut
  for (int i = 0; i < wide; ++i)
    for (int k = 0; k < deep; ++k) stage_of_node.push_back(i % 10 == 9 ? parts : i / 10);
  BlockSymbolic symbolic;
  symbolic.analyze(wide * deep, edges, stage_of_node, parts + 1);
  check_branches(symbolic);
  for (const auto& [a, b] : edges) {
    if (stage_of_node[a] < stage_of_node[b]) {
      EXPECT_LT(symbolic.position_of_node()[a], symbolic.position_of_node()[b]);
    }
  }
  double flops = 0;
  for (int stage = 0; stage <= parts; ++stage) {
    EXPECT_GT(symbolic.factor_flops(stage), 0);
    flops += symbolic.factor_flops(stage);
  }
  symbolic.analyze(wide * deep, edges);
  EXPECT_GT(flops, symbolic.factor_flops(0));
}

bool waits(const TaskGraph& graph, int earlier, int later) {
  return std::ranges::count(graph.next(earlier), later) == 1;
}

// Every branch in one task, up after all branches below it and down after all above it.
void check_groups(const BlockSymbolic& symbolic, int threads) {
  BranchGroups groups;
  groups.join(symbolic, threads);
  const int count = groups.group_count(), last = 2 * count - 1;
  ASSERT_EQ(groups.graph().task_count(), 2 * count);
  std::vector<int> group_of(symbolic.branches().size(), -1);
  for (int g = 0; g < count; ++g) {
    EXPECT_TRUE(std::ranges::is_sorted(groups.branches(g)));
    for (const int b : groups.branches(g)) {
      EXPECT_EQ(group_of[b], -1);
      group_of[b] = g;
    }
  }
  for (std::size_t b = 0; b < group_of.size(); ++b) {
    const int group = group_of[b], parent = symbolic.branches()[b].parent;
    ASSERT_GE(group, 0);
    if (parent < 0) {
      EXPECT_TRUE(waits(groups.graph(), group, last - group));
    } else if (group_of[parent] != group) {
      EXPECT_TRUE(waits(groups.graph(), group, group_of[parent]));
      EXPECT_TRUE(waits(groups.graph(), last - group_of[parent], last - group));
    }
  }
}

TEST(BranchesTest, AreJoinedIntoTasksThatKeepTheirOrder) {
  BlockSymbolic symbolic;
  for (int seed = 0; seed < 50; ++seed) {
    const Edges edges = random_edges(300, 60 + 20 * seed, seed);
    symbolic.analyze(300, edges);
    for (const int threads : {1, 2, 16}) check_groups(symbolic, threads);
  }
  symbolic.analyze(0, {});
  check_groups(symbolic, 2);
}

TEST(BranchesTest, AreJoinedOnSeveralThreadsOnly) {
  BlockSymbolic symbolic;
  const Edges edges = grid(60, 20);
  symbolic.analyze(1200, edges);
  const int branches = static_cast<int>(symbolic.branches().size());
  BranchGroups groups;
  groups.join(symbolic, 1);
  EXPECT_EQ(groups.group_count(), branches);
  groups.join(symbolic, 16);
  const int of_many = groups.group_count();
  EXPECT_LT(of_many, branches);
  groups.join(symbolic, 2);
  EXPECT_LE(groups.group_count(), of_many);
  EXPECT_GE(groups.group_count(), 6);
}

}  // namespace
}  // namespace cleave
