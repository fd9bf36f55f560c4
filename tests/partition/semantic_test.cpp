// semantic against its definition, and on graphs that name no groups.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "partition/registry.h"
#include "tests/partition/test_graphs.h"

namespace cleave::partition_test {
namespace {

Partition split(const BodyGraph& graph, const std::string& how, int max_bodies) {
  return make_partitioner("semantic@split=" + how + "@max-bodies=" + std::to_string(max_bodies))->run(graph);
}

// The definition of the head comment, a body at a time: its place in its group tells its run.
std::vector<std::pair<int, int>> names_by_definition(const std::vector<int>& group, bool whole,
                                                     int max_bodies) {
  std::vector<std::pair<int, int>> names;
  for (std::size_t body = 0; body < group.size(); ++body) {
    const auto size = static_cast<int>(std::ranges::count(group, group[body]));
    const auto place = static_cast<int>(std::count(group.begin(), group.begin() + body, group[body]));
    const int runs = whole ? 1 : (size + max_bodies - 1) / max_bodies;
    int run = 0;
    while (!(size * run / runs <= place && place < size * (run + 1) / runs)) ++run;
    names.emplace_back(group[body], run);
  }
  return names;
}

TEST(Semantic, is_as_defined) {
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    Random random(seed + 9000);
    Bodies bodies = random_bodies(seed);
    const int groups = random.integer(1, 6);
    for (int body = 0; body < bodies.count(); ++body)
      bodies.group.push_back(7 * random.integer(-1, groups - 2));
    const int max_bodies = random.integer(1, 9);
    for (const bool whole : {true, false}) {
      const Partition found = split(bodies.graph(), whole ? "whole" : "chunks", max_bodies);
      const auto names = names_by_definition(bodies.group, whole, max_bodies);
      std::map<std::pair<int, int>, int> part_of_name;
      for (int body = 0; body < bodies.count(); ++body) {
        const auto next = static_cast<int>(part_of_name.size());  // parts are numbered by their lowest body
        const int part = part_of_name.emplace(names[body], next).first->second;
        ASSERT_EQ(found.part_of_body[body], part)
            << "seed " << seed << ", whole " << whole << ", body " << body;
      }
      EXPECT_EQ(found.part_count, static_cast<int>(part_of_name.size()));
      for (const int size : part_sizes(found)) {
        if (!whole) {
          EXPECT_LE(size, max_bodies);
        }
      }
    }
  }
}

TEST(Semantic, refuses_a_graph_without_groups) {
  const BodyGraph graph(std::vector<double>(3, 1.0), {});
  try {
    split(graph, "whole", 5);
    ADD_FAILURE() << "split";
  } catch (const CannotSplit& error) {
    EXPECT_STREQ(error.what(), "semantic: the scene names no groups of bodies, which it splits by");
  }
  EXPECT_EQ(split(BodyGraph(), "whole", 5).part_count, 0);
}

TEST(Groups, go_with_the_bodies_of_a_set_and_fit_their_number) {
  BodyGraph graph(std::vector<double>(4, 1.0), {});
  EXPECT_FALSE(graph.has_groups());
  EXPECT_THROW(graph.set_groups(std::vector<int>{1, 2}), std::invalid_argument);
  graph.set_groups(std::vector<int>{5, -1, 6, 7});
  const std::vector<BodyGraph> sets = graph.induced(std::vector<int>{1, 0, -1, 1}, 2);
  EXPECT_EQ(sets[0].group(0), -1);
  EXPECT_EQ(sets[1].group(0), 5);
  EXPECT_EQ(sets[1].group(1), 7);
}

}  // namespace
}  // namespace cleave::partition_test
