// single and random, and the dice.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "harness/base/dice.h"
#include "partition/registry.h"
#include "tests/partition/test_graphs.h"

namespace cleave::partition_test {
namespace {

constexpr std::uint64_t kSeeds = 200;

TEST(Dice, throws_away_what_would_make_some_numbers_likelier) {
  // Three quarters of all words: a remainder alone would fall into the first third half of the time.
  constexpr std::uint64_t kQuarter = 1ull << 62;
  constexpr int kThrows = 3000;
  Dice dice(4);
  int share[3] = {};
  for (int k = 0; k < kThrows; ++k) ++share[dice.below(3 * kQuarter) / kQuarter];
  for (const int count : share) EXPECT_NEAR(count, kThrows / 3.0, 5 * std::sqrt(kThrows * 2 / 9.0));
}

TEST(Dice, gives_every_number_below_the_count) {
  Dice dice(5);
  std::set<std::uint64_t> seen;
  for (int k = 0; k < 400; ++k) seen.insert(dice.below(7));
  EXPECT_EQ(seen, (std::set<std::uint64_t>{0, 1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(dice.below(1), 0u);
}

TEST(Partition, is_numbered_by_its_lowest_bodies) {
  const Partition partition = numbered_by_lowest_body(std::vector<int>{4, 2, 4, 0, 2});
  EXPECT_EQ(partition.part_of_body, (std::vector<int>{0, 1, 0, 2, 1}));
  EXPECT_EQ(partition.part_count, 3);
  EXPECT_EQ(numbered_by_lowest_body({}).part_count, 0);
}

TEST(Partition, may_grow_to_a_whole_number_of_bodies) {
  EXPECT_EQ(most_grown_bodies(25, 0.2), 30);
  EXPECT_EQ(most_grown_bodies(45, 0.4), 63);  // the product of binary fractions is a little less
  EXPECT_EQ(most_grown_bodies(4, 0.2), 4);
  EXPECT_EQ(most_grown_bodies(25, 1e300), std::numeric_limits<int>::max());
}

TEST(Single, is_one_part_whatever_the_graph) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Bodies bodies = random_bodies(seed);
    const Partition partition = make_partitioner("single")->run(bodies.graph());
    EXPECT_EQ(partition.part_count, bodies.count() > 0 ? 1 : 0) << "seed " << seed;
    EXPECT_EQ(partition.part_of_body, std::vector<int>(bodies.count(), 0)) << "seed " << seed;
  }
}

Bodies loose(int count) { return {"loose", std::vector<double>(count, 1.0), {}}; }

Partition dealt(int bodies, int max_bodies, int seed) {
  return make_partitioner("random@max-bodies=" + std::to_string(max_bodies) +
                          "@partition-seed=" + std::to_string(seed))
      ->run(loose(bodies).graph());
}

TEST(RandomParts, are_as_few_and_as_equal_as_can_be) {
  for (int bodies = 1; bodies < 60; ++bodies) {
    for (const int max_bodies : {1, 2, 7, 25, 100}) {
      const Partition partition = dealt(bodies, max_bodies, bodies);
      EXPECT_EQ(partition.part_count, std::ceil(bodies / static_cast<double>(max_bodies)));
      const std::vector<int> sizes = part_sizes(partition);
      const auto [least, most] = std::ranges::minmax(sizes);
      EXPECT_LE(most - least, 1) << bodies << " bodies, " << max_bodies << " a part";
      EXPECT_EQ(numbered_by_lowest_body(partition.part_of_body).part_of_body, partition.part_of_body);
    }
  }
}

// Of six bodies in pairs any two share a part with probability 1/5.
TEST(RandomParts, join_every_two_bodies_alike) {
  constexpr int kDeals = 4000;
  int together[6][6] = {};
  for (int seed = 0; seed < kDeals; ++seed) {
    const std::vector<int> part = dealt(6, 2, seed).part_of_body;
    for (int a = 0; a < 6; ++a)
      for (int b = 0; b < a; ++b) together[a][b] += part[a] == part[b];
  }
  for (int a = 0; a < 6; ++a)
    for (int b = 0; b < a; ++b)
      EXPECT_NEAR(together[a][b], kDeals / 5.0, 5 * std::sqrt(kDeals * 0.16)) << a << " and " << b;
}

// Of three bodies in two parts the second place alone is a part, and may hold the second body.
TEST(RandomParts, leave_every_body_alone_alike) {
  constexpr int kDeals = 3000;
  int alone[3] = {};
  for (int seed = 0; seed < kDeals; ++seed) {
    const std::vector<int> part = dealt(3, 2, seed).part_of_body;
    for (int body = 0; body < 3; ++body) alone[body] += std::ranges::count(part, part[body]) == 1;
  }
  for (const int count : alone) EXPECT_NEAR(count, kDeals / 3.0, 5 * std::sqrt(kDeals * 2 / 9.0));
}

TEST(RandomParts, differ_from_seed_to_seed) {
  std::set<std::vector<int>> deals;
  for (int seed = 0; seed < 20; ++seed) deals.insert(dealt(30, 10, seed).part_of_body);
  EXPECT_EQ(deals.size(), 20u);
}

}  // namespace
}  // namespace cleave::partition_test
