// The steps that mend grown parts, each against its rule.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "partition/dissolve.h"
#include "partition/local_climbs.h"
#include "partition/partitioner.h"
#include "tests/partition/printed_rows.h"
#include "tests/partition/slow_mending.h"
#include "tests/partition/test_graphs.h"

namespace cleave::partition_test {
namespace {

// Parts dealt regardless of the graph, and a bound that they keep to.
struct Start {
  explicit Start(std::uint64_t seed)
      : bodies(random_bodies(seed)), graph(bodies.graph()), random(seed + 9000) {
    parts = random_partition(random, bodies.count());
    const std::vector<int> sizes = part_sizes(parts);
    most = (sizes.empty() ? 1 : std::ranges::max(sizes)) + random.integer(0, 2);
  }

  Bodies bodies;
  BodyGraph graph;
  Random random;
  Partition parts;
  int most = 1;
};

TEST(Dissolving, TakesApartWhatItsRuleSays) {
  int dissolved = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    Start start(seed);
    const int fewest = (start.bodies.count() + start.most - 1) / start.most;
    const int wanted = start.random.integer(fewest, std::max(fewest, start.parts.part_count));
    Partition found = start.parts;
    dissolve_smallest(start.graph, wanted, start.most, found);
    dissolved += slow_dissolve_smallest(start.bodies, wanted, start.most, start.parts);
    ASSERT_EQ(first_difference(start.parts, found), "") << "seed " << seed << ", " << wanted << " parts";
    ASSERT_EQ(found.part_count, std::min(found.part_count, wanted));
    ASSERT_EQ(find_broken_promise(start.graph, found, {.at_most_max_bodies = true}, start.most), "") << seed;
  }
  EXPECT_GT(dissolved, 300);
}

// Two islands of two in one part; the third has nobody next to it.
TEST(Dissolving, PutsWhatTouchesNobodyIntoTheSmallestPart) {
  const Bodies bodies{"", {1, 1, 1, 1, 1, 1}, {{0, 1, 3}, {1, 2, 3}, {3, 4, 3}}};
  Partition parts{{0, 0, 0, 1, 1, 2}, 3};
  dissolve_smallest(bodies.graph(), 2, 3, parts);
  EXPECT_EQ(parts.part_of_body, (std::vector<int>{0, 0, 0, 1, 1, 1}));
}

TEST(LocalClimbs, MoveWhatTheirRuleSays) {
  int moves = 0;
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    Start start(seed);
    const LocalClimbs options{start.most, start.random.integer(1, 6), start.random.integer(1, 4)};
    Partition found = start.parts;
    climb_locally(start.graph, options, found);
    moves += slow_climb_locally(start.bodies, options, start.parts);
    ASSERT_EQ(first_difference(start.parts, found), "")
        << "seed " << seed << " (" << describe(start.bodies) << "), patience " << options.patience;
  }
  EXPECT_GT(moves, 500);
}

TEST(LocalClimbs, KeepToTheBoundAndNeverCutMore) {
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    const Start start(seed);
    Partition found = start.parts;
    climb_locally(start.graph, {start.most, 10, 10}, found);
    EXPECT_LE(cut_weight(start.graph, found.part_of_body, EdgeWeight::rows),
              cut_weight(start.graph, start.parts.part_of_body, EdgeWeight::rows));
    EXPECT_EQ(find_broken_promise(start.graph, found, {.at_most_max_bodies = true}, start.most), "") << seed;
  }
}

// 0 - 1 - 2 - 3 with a light edge in the middle, cut at 0 - 1 and 2 - 3: the first move from there cuts more.
TEST(LocalClimbs, GoOverAHill) {
  const Bodies bodies{"", {1, 1, 1, 1}, {{0, 1, 9}, {1, 2, 3}, {2, 3, 9}, {0, 3, 6}}};
  Partition parts{{0, 1, 1, 0}, 2};
  climb_locally(bodies.graph(), {3, 1, 10}, parts);
  EXPECT_EQ(cut_weight(bodies.graph(), parts.part_of_body, EdgeWeight::rows), 9);
}

}  // namespace
}  // namespace cleave::partition_test
