// What the stages of a factorisation hand on to the last one: as much as they reach, not as much as there is.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "solver/block_symbolic.h"

namespace cleave {
namespace {

// A ring of `count` nodes, every second of which is in the last stage and each other one a stage of its own.
struct Ring {
  explicit Ring(int count) : stages(count / 2 + 1), stage_of_node(count) {
    for (int node = 0; node < count; ++node) {
      edges.emplace_back(node, (node + 1) % count);
      stage_of_node[node] = node % 2 == 0 ? node / 2 : count / 2;
    }
  }
  int stages;
  std::vector<int> stage_of_node;
  std::vector<std::pair<int, int>> edges;
};

TEST(LatePositionsTest, AStageOfOneNodeReachesItsNeighbours) {
  const Ring ring(3000);
  BlockSymbolic symbolic;
  symbolic.analyze(3000, ring.edges, ring.stage_of_node, ring.stages);
  for (int stage = 0; stage + 1 < ring.stages; ++stage) {
    std::set<int> expected;
    for (const int neighbour : {2 * stage + 1, (2 * stage + 2999) % 3000}) {
      expected.insert(symbolic.position_of_node()[neighbour]);
    }
    const auto found = symbolic.late_positions(stage);
    EXPECT_EQ(std::set<int>(found.begin(), found.end()), expected) << "stage " << stage;
  }
  EXPECT_TRUE(symbolic.late_positions(ring.stages - 1).empty());
}

TEST(LatePositionsTest, EveryLateRowHasItsPlace) {
  const Ring ring(40);
  BlockSymbolic symbolic;
  symbolic.analyze(40, ring.edges, ring.stage_of_node, ring.stages);
  for (const Supernode& s : symbolic.supernodes()) {
    for (int k = s.first_row + s.width; k < s.first_row + s.row_count; ++k) {
      if (s.stage == ring.stages - 1) continue;
      const auto positions = symbolic.late_positions(s.stage);
      ASSERT_GE(symbolic.late_index()[k], 0);
      EXPECT_EQ(positions[symbolic.late_index()[k]], symbolic.rows()[k]);
      EXPECT_TRUE(std::ranges::is_sorted(positions));
    }
  }
}

}  // namespace
}  // namespace cleave
