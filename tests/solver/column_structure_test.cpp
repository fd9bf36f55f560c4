// Rows of the factor's columns against elimination by hand, and the order that is chosen: the one with fewer
// flops.
#include "solver/column_structure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <set>
#include <thread>

#include "tests/solver/seeded_random.h"

namespace cleave {
namespace {

using Edges = std::vector<std::pair<int, int>>;
constexpr long kAny = std::numeric_limits<long>::max();

// Of side^3 nodes, each joined with all that are a step away along every axis, or along one axis.
Edges cube(int side, bool diagonals) {
  Edges edges;
  const auto node = [side](int x, int y, int z) { return (x * side + y) * side + z; };
  for (int i = 0; i < side * side * side; ++i) {
    const int x = i / side / side, y = i / side % side, z = i % side;
    for (int step = 0; step < 27; ++step) {
      const int dx = step / 9 - 1, dy = step / 3 % 3 - 1, dz = step % 3 - 1;
      if (!diagonals && std::abs(dx) + std::abs(dy) + std::abs(dz) != 1) continue;
      if (std::min({x + dx, y + dy, z + dz}) < 0 || std::max({x + dx, y + dy, z + dz}) >= side) continue;
      if (const int other = node(x + dx, y + dy, z + dz); other > i) edges.emplace_back(i, other);
    }
  }
  return edges;
}

Edges random_edges(SeededRandom& random, int nodes, int count) {
  Edges edges;
  for (int k = 0; k < count; ++k) {
    const int a = random.integer(0, nodes - 1), b = random.integer(0, nodes - 1);
    if (a != b) edges.emplace_back(a, b);
  }
  return edges;
}

// Eliminates node after node: the neighbours that are left become neighbours of each other.
std::vector<std::set<int>> eliminate(int nodes, const Edges& edges, std::span<const int> node_at_position) {
  std::vector<int> position(nodes);
  for (int p = 0; p < nodes; ++p) position[node_at_position[p]] = p;
  std::vector<std::set<int>> below(nodes);
  for (const auto& [a, b] : edges)
    below[std::min(position[a], position[b])].insert(std::max(position[a], position[b]));
  for (int p = 0; p < nodes; ++p) {
    if (below[p].empty()) continue;
    const int parent = *below[p].begin();
    below[parent].insert(std::next(below[p].begin()), below[p].end());
  }
  return below;
}

double flops_of(const std::vector<std::set<int>>& below) {
  double flops = 0;
  for (const std::set<int>& rows : below)
    for (int k = 1; k <= 6; ++k) flops += (6.0 * rows.size() + k) * (6.0 * rows.size() + k);
  return flops;
}

double flops_of(const ColumnStructure& columns) {
  double flops = 0;
  for (int p = 0; p < columns.node_count(); ++p) flops += columns.flops(p);
  return flops;
}

BlockGraph graph_of(int nodes, const Edges& edges, std::vector<int>& first, std::vector<int>& adjacency) {
  std::vector<std::set<int>> neighbours(nodes);
  for (const auto& [a, b] : edges) neighbours[a].insert(b), neighbours[b].insert(a);
  first.assign(1, 0);
  for (const std::set<int>& list : neighbours) {
    adjacency.insert(adjacency.end(), list.begin(), list.end());
    first.push_back(static_cast<int>(adjacency.size()));
  }
  return {first, adjacency};
}

TEST(ColumnStructureTest, HoldsTheRowsThatEliminationLeaves) {
  for (int seed = 0; seed < 40; ++seed) {
    SeededRandom random(seed);
    const int nodes = random.integer(1, 80);
    const Edges edges = random_edges(random, nodes, random.integer(0, 200));
    std::vector<int> stages;
    for (int i = 0; i < nodes && seed % 2 == 1; ++i) stages.push_back(7 * random.integer(0, 3));
    ColumnStructure columns;
    ASSERT_TRUE(columns.analyze(nodes, edges, stages, kAny));
    const std::vector<std::set<int>> below = eliminate(nodes, edges, columns.node_at_position());
    for (int p = 0; p < nodes; ++p) {
      EXPECT_TRUE(std::ranges::equal(columns.rows_below(p), below[p]))
          << "seed " << seed << ", position " << p;
      EXPECT_EQ(columns.parent(p), below[p].empty() ? -1 : *below[p].begin());
    }
    for (const auto& [a, b] : edges) {
      if (stages.empty() || stages[a] >= stages[b]) continue;
      EXPECT_LT(columns.position_of_node()[a], columns.position_of_node()[b]);
    }
  }
}

TEST(ColumnStructureTest, TakesTheOrderWithFewerFlops) {
  bool took_degree = false, took_dissection = false;
  for (const int side : {5, 9, 13, 15}) {
    for (const bool diagonals : {false, true}) {
      const Edges edges = cube(side, diagonals);
      const int nodes = side * side * side;
      std::vector<int> first, adjacency, order(nodes);
      const BlockGraph graph = graph_of(nodes, edges, first, adjacency);
      order_by_degree(graph, {}, order);
      const double by_degree = flops_of(eliminate(nodes, edges, order));
      if (!order_by_dissection(graph, order)) GTEST_SKIP() << "a build without METIS (libmetis-dev)";
      const double by_dissection = flops_of(eliminate(nodes, edges, order));
      ColumnStructure columns;
      ASSERT_TRUE(columns.analyze(nodes, edges, {}, kAny));
      const bool may_dissect = by_degree > 2e8;
      EXPECT_EQ(flops_of(columns), may_dissect ? std::min(by_degree, by_dissection) : by_degree) << side;
      took_degree |= may_dissect && by_degree < by_dissection;
      took_dissection |= may_dissect && by_dissection < by_degree;
    }
  }
  EXPECT_TRUE(took_degree && took_dissection);
}

std::size_t blocks_of(const std::vector<std::set<int>>& below) {
  std::size_t blocks = below.size();
  for (const std::set<int>& rows : below) blocks += rows.size();
  return blocks;
}

// A limit of blocks that one order keeps and the other does not.
TEST(ColumnStructureTest, FindsTheOrderThatFits) {
  for (const bool diagonals : {false, true}) {
    const int side = 13, nodes = side * side * side;
    const Edges edges = cube(side, diagonals);
    std::vector<int> first, adjacency, order(nodes);
    const BlockGraph graph = graph_of(nodes, edges, first, adjacency);
    order_by_degree(graph, {}, order);
    const std::size_t by_degree = blocks_of(eliminate(nodes, edges, order));
    if (!order_by_dissection(graph, order)) GTEST_SKIP() << "a build without METIS (libmetis-dev)";
    const std::size_t by_dissection = blocks_of(eliminate(nodes, edges, order));
    ASSERT_NE(by_degree, by_dissection);
    ColumnStructure columns;
    EXPECT_TRUE(columns.analyze(nodes, edges, {}, static_cast<long>(std::min(by_degree, by_dissection))));
    EXPECT_EQ(columns.block_count(), static_cast<long>(std::min(by_degree, by_dissection)));
    EXPECT_FALSE(
        columns.analyze(nodes, edges, {}, static_cast<long>(std::min(by_degree, by_dissection)) - 1));
  }
}

// What the library under it shares with the whole process.
TEST(ColumnStructureTest, IsTheSameBesideAnotherAndLeavesSignalsAlone) {
  struct sigaction before {
  }, after{};
  ASSERT_EQ(::sigaction(SIGTERM, nullptr, &before), 0);
  const int side = 15, nodes = side * side * side;
  const Edges edges = cube(side, true);
  ColumnStructure alone, columns[2];
  ASSERT_TRUE(alone.analyze(nodes, edges, {}, kAny));
  for (int trial = 0; trial < 3; ++trial) {
    std::thread beside([&] { columns[0].analyze(nodes, edges, {}, kAny); });
    columns[1].analyze(nodes, edges, {}, kAny);
    beside.join();
    for (const ColumnStructure& found : columns)
      EXPECT_TRUE(std::ranges::equal(found.node_at_position(), alone.node_at_position())) << trial;
  }
  ASSERT_EQ(::sigaction(SIGTERM, nullptr, &after), 0);
  EXPECT_EQ(before.sa_handler, after.sa_handler);
  EXPECT_EQ(before.sa_flags, after.sa_flags);
}

}  // namespace
}  // namespace cleave
