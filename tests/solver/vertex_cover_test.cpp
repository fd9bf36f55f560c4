// Covers of small graphs against every choice of nodes, and of graphs whose paths are as long as they are
// large.
#include "solver/vertex_cover.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <iterator>

#include "tests/solver/seeded_random.h"

namespace cleave {
namespace {

using Edges = std::vector<std::pair<int, int>>;

bool covers(const std::vector<char>& cover, const Edges& edges) {
  return std::ranges::all_of(edges, [&](auto edge) { return cover[edge.first] || cover[edge.second]; });
}

int least_cover(int nodes, const Edges& edges) {
  int least = nodes;
  for (unsigned chosen = 0; chosen < 1u << nodes; ++chosen) {
    std::vector<char> cover(nodes);
    for (int i = 0; i < nodes; ++i) cover[i] = chosen >> i & 1;
    if (covers(cover, edges)) least = std::min(least, std::popcount(chosen));
  }
  return least;
}

// The cover that alternating paths give for one maximum matching is that of every other: a left node is out
// of it where some maximum matching leaves it alone, which is where the least cover without it is no smaller.
std::vector<char> koenig_cover(int nodes, int left_nodes, const Edges& edges) {
  const auto least_without = [&](int node) {
    Edges rest;
    std::ranges::copy_if(edges, std::back_inserter(rest),
                         [&](auto edge) { return edge.first != node && edge.second != node; });
    return least_cover(nodes, rest);
  };
  std::vector<char> cover(nodes, 0);
  const int least = least_cover(nodes, edges);
  for (int left = 0; left < left_nodes; ++left) cover[left] = least_without(left) < least;
  for (const auto& [left, right] : edges) cover[right] |= !cover[left];
  return cover;
}

TEST(VertexCover, IsTheLeastOneBetweenTwoSides) {
  for (int seed = 1; seed <= 60; ++seed) {
    SeededRandom random(seed);
    constexpr int kLeft = 5, kNodes = 10;
    // Every edge from the left to the right, and each left node to the first right one: connected, and node
    // 0, which the search colours first, is on the left.
    Edges edges;
    for (int left = 0; left < kLeft; ++left) {
      edges.emplace_back(left, kLeft);
      for (int right = kLeft + 1; right < kNodes; ++right)
        if (random.chance(0.4)) edges.emplace_back(left, right);
    }
    const std::vector<char> cover = vertex_cover(kNodes, edges);
    EXPECT_TRUE(covers(cover, edges)) << "seed " << seed;
    EXPECT_EQ(std::ranges::count(cover, 1), least_cover(kNodes, edges)) << "seed " << seed;
    EXPECT_EQ(cover, koenig_cover(kNodes, kLeft, edges)) << "seed " << seed;
  }
}

// The body with most uncovered edges, lowest index on ties, until none is uncovered.
std::vector<char> greedy_cover(int nodes, const Edges& edges) {
  std::vector<char> cover(nodes, 0);
  while (!covers(cover, edges)) {
    std::vector<int> uncovered(nodes, 0);
    for (const auto& [a, b] : edges)
      if (!cover[a] && !cover[b]) ++uncovered[a], ++uncovered[b];
    cover[std::ranges::max_element(uncovered) - uncovered.begin()] = 1;
  }
  return cover;
}

TEST(VertexCover, IsGreedyWhereThereAreOddRings) {
  for (int seed = 1; seed <= 60; ++seed) {
    SeededRandom random(seed);
    Edges edges = {{0, 2}};
    for (int a = 0; a < 20; ++a)
      for (int b = a + 1; b < 20; ++b)
        if (b == a + 1 || ((a != 0 || b != 2) && random.chance(0.2))) edges.emplace_back(a, b);
    EXPECT_EQ(vertex_cover(20, edges), greedy_cover(20, edges)) << "seed " << seed;
  }
}

// Many components, each of which is only to cost its own nodes; most edges uncovered first, lowest index on
// ties.
TEST(VertexCover, OfManyTrianglesTakesTheLowerTwoOfEach) {
  constexpr int kTriangles = 100000;
  Edges edges;
  for (int t = 0; t < kTriangles; ++t)
    for (const auto& [a, b] : Edges{{0, 1}, {1, 2}, {2, 0}}) edges.emplace_back(3 * t + a, 3 * t + b);
  const std::vector<char> cover = vertex_cover(3 * kTriangles, edges);
  for (int node = 0; node < 3 * kTriangles; ++node) ASSERT_EQ(cover[node] != 0, node % 3 != 2) << node;
}

// One free node, from which alternating paths run through all others: nothing may lie on the stack for every
// node.
TEST(VertexCover, FollowsPathsOfAnyLength) {
  constexpr int kNodes = 1000001;
  Edges edges;
  for (int node = 0; node + 1 < kNodes; ++node) edges.emplace_back(node, node + 1);
  const std::vector<char> cover = vertex_cover(kNodes, edges);
  for (int node = 0; node < kNodes; ++node) ASSERT_EQ(cover[node] != 0, node % 2 == 1) << node;
}

}  // namespace
}  // namespace cleave
