// bfs@restart=graph against its definition, and graphs under other numbers.
#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <stdexcept>

#include "partition/registry.h"
#include "tests/partition/brute_force.h"
#include "tests/partition/test_graphs.h"

namespace cleave::partition_test {
namespace {

constexpr std::uint64_t kSeeds = 300;

bool adjacent(const BodyGraph& graph, int a, int b) { return std::ranges::count(graph.neighbours(a), b) > 0; }

// One search over all bodies, written straight from its definition: the queue begins with the lowest body
// that was never in it; whoever leaves it counts, and puts the neighbours that were never in it behind the
// others, ascending.
Partition chopped_search(const BodyGraph& graph, int max_bodies) {
  const int n = graph.body_count();
  std::vector<bool> was_queued(n, false);
  std::deque<int> queue;
  Partition partition{std::vector<int>(n, -1), 0};
  for (int counted = 0; counted < n; ++counted) {
    for (int body = 0; body < n && queue.empty(); ++body) {
      if (was_queued[body]) continue;
      was_queued[body] = true;
      queue.push_back(body);
    }
    const int body = queue.front();
    queue.pop_front();
    if (counted % max_bodies == 0) ++partition.part_count;
    partition.part_of_body[body] = partition.part_count - 1;
    for (int other = 0; other < n; ++other)
      if (adjacent(graph, body, other) && !was_queued[other]) {
        was_queued[other] = true;
        queue.push_back(other);
      }
  }
  return partition;
}

TEST(BfsRestart, of_the_graph_chops_one_search) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Bodies bodies = random_bodies(seed);
    const BodyGraph graph = bodies.graph();
    for (const int max_bodies : {1, 2, 3, 7, 25}) {
      const std::string name = "bfs@restart=graph@max-bodies=" + std::to_string(max_bodies);
      const auto partitioner = make_partitioner(name);
      const Partition found = partitioner->run(graph);
      ASSERT_EQ(first_difference(chopped_search(graph, max_bodies), found), "")
          << "seed " << seed << " (" << describe(bodies) << "), " << name;
      ASSERT_EQ(found.part_count, (graph.body_count() + max_bodies - 1) / max_bodies);
      ASSERT_EQ(find_broken_promise(graph, found, partitioner->promised(), max_bodies), "");
    }
  }
}

TEST(BfsRestart, of_a_part_is_the_default_and_another) {
  int others = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const BodyGraph graph = random_bodies(seed).graph();
    const Partition usual = make_partitioner("bfs@max-bodies=4")->run(graph);
    ASSERT_EQ(first_difference(usual, make_partitioner("bfs@restart=part@max-bodies=4")->run(graph)), "");
    others +=
        !first_difference(usual, make_partitioner("bfs@restart=graph@max-bodies=4")->run(graph)).empty();
  }
  EXPECT_GE(others, 100);
}

TEST(BfsRestart, promises_what_it_keeps) {
  EXPECT_TRUE(make_partitioner("bfs")->promised().contiguous);
  const PartsPromise chopped = make_partitioner("bfs@restart=graph")->promised();
  EXPECT_TRUE(chopped.at_most_max_bodies);
  EXPECT_FALSE(chopped.contiguous || chopped.grown_in_order);
  EXPECT_FALSE(make_partitioner("bfs@restart=graph@merge-small=true")->promised().contiguous);
}

TEST(BfsRestart, names_what_may_be_given) {
  try {
    make_partitioner("bfs@restart=grph");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("'graph'"), std::string::npos) << error.what();
  }
}

// Numbers, links and all that bodies carry, against a graph built from renumbered links.
TEST(BodyGraph, renumbered_is_built_from_renumbered_links) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Bodies bodies = random_bodies(seed);
    const int n = bodies.count();
    const std::vector<int> number = Random(seed + 5).permutation(n);
    Bodies other{bodies.family, std::vector<double>(n), bodies.links, std::vector<double>(3 * n),
                 std::vector<int>(n)};
    const std::vector<double> positions = bodies.positions();
    const std::vector<int> groups = bodies.groups();
    for (int i = 0; i < n; ++i) {
      other.mass_kg[number[i]] = bodies.mass_kg[i];
      other.group[number[i]] = groups[i];
      for (int axis = 0; axis < 3; ++axis) other.position_m[3 * number[i] + axis] = positions[3 * i + axis];
    }
    for (ConstraintLink& link : other.links) {
      if (link.body_a >= 0) link.body_a = number[link.body_a];
      if (link.body_b >= 0) link.body_b = number[link.body_b];
    }
    const BodyGraph expected = other.graph(), found = bodies.graph().renumbered(number);
    ASSERT_EQ(found.body_count(), n);
    for (int i = 0; i < n; ++i) {
      ASSERT_TRUE(std::ranges::equal(found.neighbours(i), expected.neighbours(i))) << "seed " << seed;
      ASSERT_EQ(found.mass_kg(i), expected.mass_kg(i));
      ASSERT_EQ(found.fixed_rows(i), expected.fixed_rows(i));
      ASSERT_EQ(found.group(i), expected.group(i));
      for (int axis = 0; axis < 3; ++axis) ASSERT_EQ(found.position_m(i, axis), expected.position_m(i, axis));
      for (int k = found.first(i); k < found.last(i); ++k)
        for (const EdgeWeight unit : {EdgeWeight::pairs, EdgeWeight::constraints, EdgeWeight::rows})
          ASSERT_EQ(found.weight(k, unit), expected.weight(k, unit));
    }
  }
}

}  // namespace
}  // namespace cleave::partition_test
