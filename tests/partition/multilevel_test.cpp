// Joining, splitting and bisecting the graphs of a multilevel scheme, against counts from scratch and known
// cuts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "partition/bisection.h"
#include "partition/level_moves.h"
#include "partition/registry.h"
#include "tests/partition/test_graphs.h"

namespace cleave::partition_test {
namespace {

LevelGraph level_graph(const BodyGraph& graph) {
  LevelGraph level;
  level.take(graph, EdgeWeight::rows);
  return level;
}

long cut_of(const LevelGraph& graph, const std::vector<char>& side) {
  long twice = 0;
  for (int node = 0; node < graph.node_count(); ++node)
    for (int k = graph.first[node]; k < graph.first[node + 1]; ++k)
      twice += side[node] != side[graph.neighbour[k]] ? graph.weight[k] : 0;
  return twice / 2;
}

int bodies_of(const LevelGraph& graph, const std::vector<char>& side, int s) {
  int bodies = 0;
  for (int node = 0; node < graph.node_count(); ++node) bodies += side[node] == s ? graph.bodies[node] : 0;
  return bodies;
}

Bodies grid(int width, int height) {
  Bodies bodies{"grid", std::vector<double>(width * height, 1.0), {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      if (x + 1 < width) bodies.links.push_back({y * width + x, y * width + x + 1, 3});
      if (y + 1 < height) bodies.links.push_back({y * width + x, (y + 1) * width + x, 3});
    }
  return bodies;
}

TEST(LevelGraph, weighs_edges_in_what_all_weights_share) {
  const LevelGraph level = level_graph(Bodies{"", {1, 1, 1}, {{0, 1, 6}, {1, 2, 9}}}.graph());
  EXPECT_EQ(level.weight, (std::vector<int>{2, 2, 3, 3}));
}

// Whatever is split on the coarse graph cuts the same weight on the fine one.
TEST(Coarsening, keeps_bodies_and_cuts) {
  Coarsening coarsening;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    const LevelGraph fine = level_graph(random_bodies(seed).graph());
    const int most = random.integer(2, 5);
    std::vector<int> coarse_of_node;
    LevelGraph coarse;
    const int nodes =
        coarsening.match(fine, most, random.integer(0, std::max(fine.node_count(), 1) - 1), coarse_of_node);
    coarsening.contract(fine, coarse_of_node, nodes, coarse);
    ASSERT_EQ(coarse.node_count(), nodes);
    EXPECT_EQ(coarse.body_count(), fine.body_count());
    std::vector<int> joined(nodes, 0);
    for (const int c : coarse_of_node) ++joined[c];
    for (int c = 0; c < nodes; ++c) {
      EXPECT_TRUE(joined[c] == 1 || joined[c] == 2);
      EXPECT_LE(coarse.bodies[c], most);
    }
    std::vector<char> side(nodes), finer;
    for (char& s : side) s = static_cast<char>(random.integer(0, 1));
    for (const int c : coarse_of_node) finer.push_back(side[c]);
    EXPECT_EQ(cut_of(coarse, side), cut_of(fine, finer)) << "seed " << seed;
  }
}

TEST(Coarsening, joins_by_the_heaviest_edge) {
  Coarsening coarsening;
  std::vector<int> coarse_of_node;
  const Bodies path{"path", {1, 1, 1, 1}, {{0, 1, 3}, {1, 2, 9}, {2, 3, 3}}};
  EXPECT_EQ(coarsening.match(level_graph(path.graph()), 2, 0, coarse_of_node), 2);
  EXPECT_EQ(coarse_of_node, (std::vector<int>{0, 0, 1, 1}));  // the ends, of least degree, choose first
  EXPECT_EQ(coarsening.match(level_graph(path.graph()), 1, 0, coarse_of_node), 4);
}

TEST(LevelGraph, splits_into_the_edges_of_both_sides) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    const LevelGraph graph = level_graph(random_bodies(seed).graph());
    std::vector<char> side(graph.node_count());
    for (char& s : side) s = static_cast<char>(random.integer(0, 1));
    std::array<LevelGraph, 2> halves;
    std::array<std::vector<int>, 2> nodes;
    std::vector<int> place;
    graph.split(side, halves, nodes, place);
    const auto total = [](const LevelGraph& g) {
      return std::accumulate(g.weight.begin(), g.weight.end(), 0L) / 2;
    };
    EXPECT_EQ(halves[0].node_count() + halves[1].node_count(), graph.node_count());
    EXPECT_EQ(total(halves[0]) + total(halves[1]) + cut_of(graph, side), total(graph)) << "seed " << seed;
    for (int s = 0; s < 2; ++s) {
      EXPECT_TRUE(std::ranges::is_sorted(nodes[s]));
      for (const int node : nodes[s]) EXPECT_EQ(side[node], s);
    }
  }
}

// Nodes of one and two bodies, in parts as they fall.
struct RandomParts {
  LevelGraph graph;
  int part_count;
  std::vector<int> part_of_node;

  explicit RandomParts(std::uint64_t seed) {
    Random random(seed);
    const LevelGraph fine = level_graph(random_bodies(seed).graph());
    std::vector<int> coarse_of_node;
    Coarsening coarsening;
    coarsening.contract(fine, coarse_of_node, coarsening.match(fine, 2, 0, coarse_of_node), graph);
    part_count = random.integer(1, 6);
    for (int node = 0; node < graph.node_count(); ++node)
      part_of_node.push_back(node < part_count ? node : random.integer(0, part_count - 1));
  }

  long cut() const {
    long twice = 0;
    for (int node = 0; node < graph.node_count(); ++node)
      for (int k = graph.first[node]; k < graph.first[node + 1]; ++k)
        twice += part_of_node[node] != part_of_node[graph.neighbour[k]] ? graph.weight[k] : 0;
    return twice / 2;
  }

  std::vector<int> bodies_of_parts() const {
    std::vector<int> bodies(part_count, 0);
    for (int node = 0; node < graph.node_count(); ++node) bodies[part_of_node[node]] += graph.bodies[node];
    return bodies;
  }

  // By a count of both cuts.
  long least_cut_of_a_move() const {
    long least = cut();
    for (int node = 0; node < graph.node_count(); ++node) {
      const int own = part_of_node[node];
      if (std::ranges::count(part_of_node, own) == 1) continue;  // a part keeps a node
      for (int part = 0; part < part_count; ++part) {
        RandomParts moved = *this;
        moved.part_of_node[node] = part;
        least = std::min(least, moved.cut());
      }
    }
    return least;
  }
};

// Run again, as what was the last node of its part when it was due may have company by the end.
TEST(LevelMoves, end_where_no_move_lowers_the_cut) {
  int lowered = 0, again = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    RandomParts parts(seed);
    const long before = parts.cut();
    LevelMoves moves(parts.part_count, parts.graph.body_count());
    moves.run(parts.graph, parts.part_of_node);
    for (std::vector<int> last; last != parts.part_of_node;) {
      const long cut = parts.cut();
      last = parts.part_of_node;
      moves.run(parts.graph, parts.part_of_node);
      again += parts.cut() < cut;
    }
    EXPECT_EQ(parts.least_cut_of_a_move(), parts.cut()) << "seed " << seed;
    EXPECT_LE(parts.cut(), before);
    lowered += parts.cut() < before;
  }
  EXPECT_GT(lowered, 100);
  EXPECT_LT(again, 20);
}

TEST(LevelMoves, keep_bounds_and_empty_no_part) {
  int at_bound = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    RandomParts parts(seed);
    const std::vector<int> before = parts.bodies_of_parts();
    const int most = parts.graph.body_count() / parts.part_count + 2;
    const long cut_before = parts.cut();
    LevelMoves(parts.part_count, most).run(parts.graph, parts.part_of_node);
    EXPECT_LE(parts.cut(), cut_before) << "seed " << seed;
    const std::vector<int> after = parts.bodies_of_parts();
    for (int part = 0; part < parts.part_count; ++part) {
      EXPECT_LE(after[part], std::max(most, before[part])) << "seed " << seed;
      EXPECT_EQ(after[part] > 0, before[part] > 0) << "seed " << seed;
      at_bound += after[part] == most;
    }
  }
  EXPECT_GT(at_bound, 50);
}

// The cut that is kept up to date by gains is the one counted from scratch, and bounds are kept.
TEST(Bisection, counts_its_cut_right_and_keeps_its_bounds) {
  Bisection bisection({.coarse_nodes = 12, .growths = 3, .patience = 10, .most_passes = 3});
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random random(seed);
    const LevelGraph graph = level_graph(random_bodies(seed).graph());
    const int n = graph.node_count();
    if (n < 2) continue;
    const int wanted = random.integer(1, n - 1);
    const std::array<int, 2> most{wanted + random.integer(0, 3), n - wanted + random.integer(0, 3)};
    Dice dice(seed);
    std::vector<char> side;
    const long cut = bisection.run(graph, wanted, most, dice, side);
    EXPECT_EQ(cut, cut_of(graph, side)) << "seed " << seed;
    for (int s = 0; s < 2; ++s) EXPECT_LE(bodies_of(graph, side, s), most[s]) << "seed " << seed;
  }
}

TEST(Bisection, finds_the_cuts_of_a_path_a_grid_and_a_dumb_bell) {
  Bisection bisection({.coarse_nodes = 16, .growths = 4, .patience = 20, .most_passes = 4});
  const auto cut = [&](const Bodies& bodies) {
    Dice dice(1);
    std::vector<char> side;
    const int n = bodies.count();
    return bisection.run(level_graph(bodies.graph()), n / 2, {n / 2 + 1, n / 2 + 1}, dice, side);
  };
  EXPECT_EQ(cut(grid(40, 1)), 1);
  EXPECT_EQ(cut(grid(20, 6)), 6);
  Bodies bell{"dumb-bell", std::vector<double>(24, 1.0), {{0, 12, 3}}};
  for (int bell_first : {0, 12})
    for (int i = 0; i < 12; ++i)
      for (int j = 0; j < i; ++j) bell.links.push_back({bell_first + i, bell_first + j, 3});
  EXPECT_EQ(cut(bell), 1);
}

class MultilevelTest : public testing::TestWithParam<std::string> {};

TEST_P(MultilevelTest, makes_as_many_parts_as_asked_within_their_bound) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    const Bodies bodies = random_bodies(seed);
    const int max_bodies = random.integer(1, 12), n = bodies.count();
    const double growth = random.pick(std::vector<double>{0, 0.2, 0.5});
    const auto multilevel = make_partitioner(GetParam() + "@max-bodies=" + std::to_string(max_bodies) +
                                             "@max-growth=" + std::to_string(growth));
    const Partition partition = multilevel->run(bodies.graph());
    EXPECT_LE(partition.part_count, (n + max_bodies - 1) / max_bodies);
    for (const int size : part_sizes(partition))
      EXPECT_LE(size, std::floor((1 + growth) * max_bodies + 1e-9));
  }
}

// Blocks of 5 x 5 cut 80 of the 180 edges of a grid of 10 x 10 less than any strips do.
TEST_P(MultilevelTest, cuts_a_grid_into_blocks) {
  const BodyGraph graph = grid(10, 10).graph();
  const Partition partition = make_partitioner(GetParam())->run(graph);
  EXPECT_EQ(partition.part_count, 4);
  EXPECT_LE(cut_weight(graph, partition.part_of_body, EdgeWeight::pairs), 22);
}

TEST_P(MultilevelTest, beats_growing_on_piles) {
  Random random(3);
  const BodyGraph graph = pile(random, 10, 10, 6).graph();
  Partition grown = make_partitioner("mix")->run(graph);
  make_refiner("fm")->run(graph, 25, grown);
  const Partition split = make_partitioner(GetParam())->run(graph);
  EXPECT_LT(measure_partition(graph, split.part_of_body).interface_rows,
            0.9 * measure_partition(graph, grown.part_of_body).interface_rows);
}

TEST_P(MultilevelTest, draws_from_its_seed_alone) {
  Random random(4);
  const BodyGraph graph = pile(random, 8, 8, 4).graph();
  const auto of = [&](int seed) {
    return make_partitioner(GetParam() + "@partition-seed=" + std::to_string(seed))->run(graph).part_of_body;
  };
  bool differs = false;
  for (int seed = 1; seed < 9; ++seed) {
    EXPECT_EQ(of(seed), of(seed));
    differs = differs || of(seed) != of(1);
  }
  EXPECT_TRUE(differs);
}

INSTANTIATE_TEST_SUITE_P(Efforts, MultilevelTest,
                         testing::Values("multilevel@effort=fast", "multilevel@effort=best"),
                         [](const auto& info) { return info.param.substr(info.param.size() - 4); });

}  // namespace
}  // namespace cleave::partition_test
