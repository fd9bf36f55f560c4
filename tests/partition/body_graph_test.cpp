// BodyGraph against the raw links it was built from.
#include "partition/body_graph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>

#include "tests/partition/brute_force.h"
#include "tests/partition/test_graphs.h"

namespace cleave::partition_test {
namespace {

constexpr std::uint64_t kSeeds = 200;
constexpr EdgeWeight kUnits[] = {EdgeWeight::pairs, EdgeWeight::constraints, EdgeWeight::rows};

WeightMatrix stored_weights(const BodyGraph& graph, EdgeWeight unit) {
  WeightMatrix weights(graph.body_count(), std::vector<long>(graph.body_count(), 0));
  for (int body = 0; body < graph.body_count(); ++body) {
    for (int half = graph.first(body); half < graph.last(body); ++half) {
      weights[body][graph.neighbour(half)] += graph.weight(half, unit);
    }
  }
  return weights;
}

TEST(BodyGraph, holds_the_merged_links) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Bodies bodies = random_bodies(seed);
    const BodyGraph graph = bodies.graph();
    ASSERT_EQ(graph.body_count(), bodies.count());
    for (const EdgeWeight unit : kUnits) {
      ASSERT_EQ(stored_weights(graph, unit), link_weights(bodies, unit)) << "seed " << seed;
    }
    for (int body = 0; body < bodies.count(); ++body) ASSERT_EQ(graph.mass_kg(body), bodies.mass_kg[body]);
  }
}

TEST(BodyGraph, lists_each_neighbour_once_in_ascending_order) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Bodies bodies = random_bodies(seed);
    const BodyGraph graph = bodies.graph();
    const WeightMatrix adjacent = link_weights(bodies, EdgeWeight::pairs);
    int half_edges = 0;
    for (int body = 0; body < bodies.count(); ++body) {
      std::vector<int> expected;
      for (int other = 0; other < bodies.count(); ++other) {
        if (adjacent[body][other] != 0) expected.push_back(other);
      }
      const std::span<const int> neighbours = graph.neighbours(body);
      ASSERT_TRUE(std::ranges::equal(neighbours, expected)) << "seed " << seed << ", body " << body;
      ASSERT_EQ(graph.degree(body), static_cast<int>(expected.size()))
          << "seed " << seed << ", body " << body;
      half_edges += graph.degree(body);
    }
    ASSERT_EQ(graph.edge_count() * 2, half_edges) << "seed " << seed;
  }
}

TEST(BodyGraph, does_not_depend_on_the_order_of_the_links) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Bodies bodies = random_bodies(seed);
    Bodies turned = bodies;
    std::ranges::reverse(turned.links);
    for (ConstraintLink& link : turned.links) std::swap(link.body_a, link.body_b);
    for (const EdgeWeight unit : kUnits) {
      ASSERT_EQ(stored_weights(turned.graph(), unit), stored_weights(bodies.graph(), unit))
          << "seed " << seed;
    }
  }
}

TEST(BodyGraph, of_nothing_is_empty) {
  EXPECT_EQ(BodyGraph().body_count(), 0);
  EXPECT_EQ(BodyGraph().edge_count(), 0);
  EXPECT_EQ(Bodies{}.graph().body_count(), 0);
  const BodyGraph single = Bodies{"", {2.5}, {{0, -1, 3}, {0, 0, 3}, {-1, -1, 3}}}.graph();
  EXPECT_EQ(single.degree(0), 0);
  EXPECT_EQ(single.edge_count(), 0);
}

// Twenty bodies and fifteen good links, then the bad one: index 15 must be in the message.
std::string link_error(ConstraintLink bad) {
  Bodies bodies{"", std::vector<double>(20, 1.0), std::vector<ConstraintLink>(15, {0, 1, 3})};
  bodies.links.push_back(bad);
  try {
    bodies.graph();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(BodyGraph, names_a_bad_link) {
  for (const ConstraintLink& bad : {ConstraintLink{0, 20, 3},
                                    {20, 0, 3},
                                    {-2, 0, 3},
                                    {0, -2, 3},
                                    {0, 1, 0},
                                    {0, 1, -1},
                                    {0, -1, 0},
                                    {3, 3, 0}}) {
    const std::string message = link_error(bad);
    EXPECT_NE(message.find("link"), std::string::npos) << message;
    EXPECT_NE(message.find("15"), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
  EXPECT_EQ(link_error({19, -1, 1}), "accepted");
}

TEST(BodyGraph, names_a_bad_mass) {
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad_kg : {0.0, -1.0, infinity, -infinity, std::numeric_limits<double>::quiet_NaN()}) {
    Bodies bodies{"", std::vector<double>(20, 1.0), {}};
    bodies.mass_kg[17] = bad_kg;
    try {
      bodies.graph();
      ADD_FAILURE() << bad_kg << " was accepted";
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("17"), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("mass"), std::string::npos) << error.what();
    }
  }
}

TEST(BodyGraph, refuses_weights_that_would_overflow) {
  constexpr int kMost = std::numeric_limits<int>::max() / 4;
  EXPECT_NO_THROW((Bodies{"", {1.0, 1.0}, {{0, 1, kMost}}}.graph()));
  EXPECT_THROW((Bodies{"", {1.0, 1.0}, {{0, 1, kMost}, {1, 0, 1}}}.graph()), std::invalid_argument);
}

std::string position_error(const std::vector<double>& position_m) {
  try {
    Bodies{"", std::vector<double>(20, 1.0), {}, position_m}.graph();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(BodyGraph, names_a_bad_position) {
  EXPECT_EQ(position_error(std::vector<double>(60, -1.5)), "accepted");
  EXPECT_EQ(position_error(std::vector<double>(59, 1.0)), "size of position_m is 59, allowed: 60");
  std::vector<double> position_m(60, 1.0);
  position_m[3 * 17 + 2] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(position_error(position_m), "position_m of body 17 is inf, allowed: finite");
}

TEST(BodyGraph, may_have_no_positions) {
  const BodyGraph graph(std::vector<double>(3, 1.0), {});
  EXPECT_FALSE(graph.has_positions());
  EXPECT_FALSE(graph.induced(std::vector<int>{0, -1, 0}, 1).front().has_positions());
  EXPECT_TRUE(Bodies({"", {1.0}, {}}).graph().has_positions());
}

// The bodies of a set and the links among them, in their order.
Bodies only(const Bodies& bodies, const std::vector<int>& set_of_body, int set) {
  Bodies kept{bodies.family, {}, {}};
  std::vector<int> index(bodies.count(), -1);
  for (int body = 0; body < bodies.count(); ++body) {
    if (set_of_body[body] != set) continue;
    index[body] = kept.count();
    kept.mass_kg.push_back(bodies.mass_kg[body]);
    kept.position_m.insert(kept.position_m.end(), &bodies.position_m[3 * body],
                           &bodies.position_m[3 * body] + 3);
  }
  for (const ConstraintLink& link : bodies.links)
    if (link.body_a >= 0 && link.body_b >= 0 && index[link.body_a] >= 0 && index[link.body_b] >= 0)
      kept.links.push_back({index[link.body_a], index[link.body_b], link.rows});
  return kept;
}

TEST(InducedGraphs, are_those_of_the_links_among_their_bodies) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Bodies bodies = random_bodies(seed);
    Random random(seed);
    const int sets = random.integer(1, 5);
    std::vector<int> set_of_body;
    for (int body = 0; body < bodies.count(); ++body) set_of_body.push_back(random.integer(-1, sets - 1));
    const std::vector<BodyGraph> graphs = bodies.graph().induced(set_of_body, sets);
    ASSERT_EQ(static_cast<int>(graphs.size()), sets);
    for (int set = 0; set < sets; ++set) {
      const BodyGraph expected = only(bodies, set_of_body, set).graph();
      ASSERT_EQ(graphs[set].body_count(), expected.body_count()) << "seed " << seed;
      for (const EdgeWeight unit : kUnits)
        ASSERT_EQ(stored_weights(graphs[set], unit), stored_weights(expected, unit)) << "seed " << seed;
      for (int body = 0; body < expected.body_count(); ++body) {
        ASSERT_EQ(graphs[set].mass_kg(body), expected.mass_kg(body)) << "seed " << seed;
        for (const int axis : {0, 1, 2})
          ASSERT_EQ(graphs[set].position_m(body, axis), expected.position_m(body, axis)) << "seed " << seed;
        ASSERT_TRUE(std::ranges::equal(graphs[set].neighbours(body), expected.neighbours(body)));
      }
    }
  }
}

TEST(CountIslands, agrees_with_union_find) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Bodies bodies = random_bodies(seed);
    const std::vector<int> expected = islands_by_union_find(bodies);
    std::vector<int> island_of_body{-5, -5, -5};  // what was in it before must not matter
    const int islands = count_islands(bodies.graph(), &island_of_body);
    ASSERT_EQ(island_of_body, expected) << "seed " << seed;
    ASSERT_EQ(islands, static_cast<int>(std::set(expected.begin(), expected.end()).size()))
        << "seed " << seed;
    ASSERT_EQ(count_islands(bodies.graph()), islands) << "seed " << seed;
  }
}

TEST(CountIslands, of_two_pairs_and_a_loner) {
  const Bodies bodies{
      "", std::vector<double>(5, 1.0), {{4, 1, 3}, {0, 3, 3}, {2, -1, 3}, {0, -1, 3}, {1, -1, 3}}};
  std::vector<int> island_of_body;
  EXPECT_EQ(count_islands(bodies.graph(), &island_of_body), 3);
  EXPECT_EQ(island_of_body, (std::vector<int>{0, 1, 2, 0, 1}));
}

TEST(CountPieces, counts_the_connected_pieces_of_all_parts) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Bodies bodies = random_bodies(seed);
    Random random(seed);
    const Partition partition = random_partition(random, bodies.count());
    Bodies inner = bodies;  // without the links at the cut, a piece is an island
    std::erase_if(inner.links, [&](const ConstraintLink& link) {
      return link.body_a >= 0 && link.body_b >= 0 &&
             partition.part_of_body[link.body_a] != partition.part_of_body[link.body_b];
    });
    const std::vector<int> island = islands_by_union_find(inner);
    ASSERT_EQ(count_pieces(bodies.graph(), partition.part_of_body),
              static_cast<int>(std::set(island.begin(), island.end()).size()))
        << "seed " << seed;
  }
}

}  // namespace
}  // namespace cleave::partition_test
