// Repairing against its rule, by a twin that counts everything anew at every step.
#include "partition/repair.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include "partition/registry.h"
#include "tests/partition/printed_rows.h"
#include "tests/partition/test_graphs.h"

namespace cleave::partition_test {
namespace {

Partition slow_take_over(const Bodies& bodies, const std::vector<int>& given, int most) {
  Partition parts;
  const std::set<int> used(given.begin(), given.end());
  for (const int part : given)
    parts.part_of_body.push_back(
        part < 0 ? -1 : static_cast<int>(std::distance(used.lower_bound(0), used.find(part))));
  parts.part_count = static_cast<int>(std::distance(used.lower_bound(0), used.end()));
  for (int body = 0; body < bodies.count(); ++body) {
    if (parts.part_of_body[body] >= 0) continue;
    std::pair best{0L, parts.part_count};  // - rows, part
    for (int part = 0; part < parts.part_count; ++part)
      if (bodies_in(parts, part) < most) best = std::min(best, {-rows_into(bodies, parts, body, part), part});
    const int part = best.first < 0 ? best.second : parts.part_count++;
    parts.part_of_body[body] = part;
  }
  return parts;
}

int slow_move_changed(const Bodies& bodies, const std::vector<char>& may_move, int most, Partition& parts) {
  for (int moves = 0;; ++moves) {
    std::optional<std::tuple<long, int, int>> best;  // - gain, body, part
    for (int body = 0; body < bodies.count(); ++body) {
      const int from = parts.part_of_body[body];
      if (!may_move[body] || bodies_in(parts, from) < 2) continue;
      for (int to = 0; to < parts.part_count; ++to) {
        if (to == from || bodies_in(parts, to) >= most) continue;
        const long gain = rows_into(bodies, parts, body, to) - rows_into(bodies, parts, body, from);
        const std::tuple found{-gain, body, to};
        if (gain > 0 && (!best || found < *best)) best = found;
      }
    }
    if (!best) return moves;
    parts.part_of_body[std::get<1>(*best)] = std::get<2>(*best);
  }
}

// An earlier partition with bodies taken out of their parts, parts taken away, and bodies that may move.
struct Case {
  explicit Case(std::uint64_t seed) : bodies(random_bodies(seed)) {
    Random random(seed + 7000);
    most = random.integer(1, 9);
    const int ids = random.integer(1, 12);
    std::map<int, int> sizes;
    for (int body = 0; body < bodies.count(); ++body) {
      const int part = random.integer(-2, ids);
      given.push_back(part < 0 || sizes[part] >= most ? -1 : part);
      sizes[part] += 1;
      may_move.push_back(static_cast<char>(random.integer(0, 1)));
    }
  }

  Bodies bodies;
  int most = 1;
  std::vector<int> given;
  std::vector<char> may_move;
};

TEST(Repair, DoesWhatItsRuleSays) {
  int moves = 0, opened = 0;
  for (std::uint64_t seed = 0; seed < 600; ++seed) {
    const Case c(seed);
    const BodyGraph graph = c.bodies.graph();
    Partition expected = slow_take_over(c.bodies, c.given, c.most);
    Partition found = take_over(graph, c.given, c.most);
    ASSERT_EQ(first_difference(expected, found), "") << "taken over, seed " << seed;
    opened += std::ranges::max(c.given.empty() ? std::vector{0} : c.given) < found.part_count - 1;
    moves += slow_move_changed(c.bodies, c.may_move, c.most, expected);
    move_changed(graph, c.may_move, c.most, found);
    ASSERT_EQ(first_difference(expected, found), "") << "moved, seed " << seed;
  }
  EXPECT_GT(moves, 300);
  EXPECT_GT(opened, 30);
}

TEST(Repair, KeepsToItsBoundsAndNeverCutsMore) {
  for (std::uint64_t seed = 0; seed < 600; ++seed) {
    const Case c(seed);
    const BodyGraph graph = c.bodies.graph();
    Partition parts = take_over(graph, c.given, c.most);
    const long before = cut_weight(graph, parts.part_of_body, EdgeWeight::rows);
    const Partition taken = parts;
    move_changed(graph, c.may_move, c.most, parts);
    EXPECT_LE(cut_weight(graph, parts.part_of_body, EdgeWeight::rows), before);
    EXPECT_EQ(find_broken_promise(graph, parts, {.at_most_max_bodies = true}, c.most), "") << "seed " << seed;
    for (int body = 0; body < c.bodies.count(); ++body)
      EXPECT_TRUE(c.may_move[body] || parts.part_of_body[body] == taken.part_of_body[body]) << body;
  }
}

TEST(Repair, LeavesAloneWhatDidNotChange) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const BodyGraph graph = random_bodies(seed).graph();
    const Partition grown = make_partitioner("mix@max-bodies=6")->run(graph);
    EXPECT_EQ(std::ranges::count(changed_bodies(graph, graph), 1), 0);
    EXPECT_EQ(first_difference(grown, take_over(graph, grown.part_of_body, 6)), "");
  }
}

TEST(Repair, TellsWhoseNeighboursChanged) {
  const std::vector<double> masses(4, 1.0), more(5, 1.0);
  const std::vector<ConstraintLink> links = {{0, 1, 3}, {2, 3, 3}};
  const std::vector<ConstraintLink> heavier = {{0, 1, 6}, {2, 3, 3}}, other = {{0, 1, 3}, {1, 2, 3}};
  const BodyGraph graph(masses, links);
  EXPECT_EQ(changed_bodies(graph, BodyGraph(masses, heavier)), (std::vector<char>{0, 0, 0, 0}));
  EXPECT_EQ(changed_bodies(graph, BodyGraph(masses, other)), (std::vector<char>{0, 1, 1, 1}));
  EXPECT_EQ(changed_bodies(graph, BodyGraph(more, links)), (std::vector<char>{0, 0, 0, 0, 1}));
  EXPECT_EQ(changed_bodies(BodyGraph(more, links), graph), (std::vector<char>{0, 0, 0, 0}));
}

TEST(Repair, WantsOneIdABody) {
  const std::vector<double> masses(2, 1.0);
  EXPECT_THROW(take_over(BodyGraph(masses, {}), std::vector<int>{0}, 3), std::invalid_argument);
  EXPECT_EQ(take_over(BodyGraph(), {}, 3).part_count, 0);
}

}  // namespace
}  // namespace cleave::partition_test
