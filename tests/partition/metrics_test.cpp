// Partition metrics against the raw links, and by hand on one small graph.
#include <gtest/gtest.h>

#include <stdexcept>

#include "partition/partition.h"
#include "tests/partition/brute_force.h"
#include "tests/partition/slow_twins.h"
#include "tests/partition/test_graphs.h"

namespace cleave::partition_test {
namespace {

constexpr std::uint64_t kSeeds = 200;

void expect_equal(const PartitionMetrics& expected, const PartitionMetrics& actual) {
  EXPECT_EQ(expected.parts, actual.parts);
  EXPECT_EQ(expected.max_part_bodies, actual.max_part_bodies);
  EXPECT_EQ(expected.cut_pairs, actual.cut_pairs);
  EXPECT_EQ(expected.cut_constraints, actual.cut_constraints);
  EXPECT_EQ(expected.interface_rows, actual.interface_rows);
  EXPECT_EQ(expected.interface_bodies, actual.interface_bodies);
  EXPECT_EQ(expected.interface_cover_bodies, actual.interface_cover_bodies);
  EXPECT_EQ(expected.contiguous, actual.contiguous);
  EXPECT_EQ(expected.part_mass_ratio_max, actual.part_mass_ratio_max);
}

// Parts {0, 2}, {1, 3}, {4, 5}:
//
//     0 ===== 1       0-1 two contacts of 3 rows; 0-2 a joint of 5; 0-3, 1-3, 2-3, 3-4 a contact of 3;
//     | \     |       4-5 a contact of 1 row; 0 and 5 touch the ground.
//     2 - 3 --+
//         |
//         4 - 5
Bodies six_bodies() {
  return {"six bodies",
          {1, 8, 4, 2, 1, 1},
          {{0, 1, 3},
           {1, 0, 3},
           {0, 2, 5},
           {3, 0, 3},
           {1, 3, 3},
           {2, 3, 3},
           {3, 4, 3},
           {4, 5, 1},
           {0, -1, 3},
           {-1, 5, 3}}};
}

TEST(Metrics, by_hand) {
  const PartitionMetrics metrics = measure_partition(six_bodies().graph(), std::vector{0, 1, 0, 1, 2, 2});
  EXPECT_EQ(metrics.parts, 3);
  EXPECT_EQ(metrics.max_part_bodies, 2);
  EXPECT_EQ(metrics.cut_pairs, 4);        // 0-1, 0-3, 2-3, 3-4
  EXPECT_EQ(metrics.cut_constraints, 5);  // 0-1 counts twice
  EXPECT_EQ(metrics.interface_rows, 15);
  EXPECT_EQ(metrics.interface_bodies, 5);        // all but 5
  EXPECT_EQ(metrics.interface_cover_bodies, 2);  // 3, then 0
  EXPECT_TRUE(metrics.contiguous);
  EXPECT_EQ(metrics.part_mass_ratio_max, 4);  // 4 kg / 1 kg and 8 kg / 2 kg
}

TEST(Metrics, of_a_part_in_two_pieces_by_hand) {
  const PartitionMetrics metrics = measure_partition(six_bodies().graph(), std::vector{0, 1, 1, 1, 1, 0});
  EXPECT_EQ(metrics.parts, 2);
  EXPECT_EQ(metrics.max_part_bodies, 4);
  EXPECT_EQ(metrics.cut_pairs, 4);  // 0-1, 0-2, 0-3, 4-5
  EXPECT_EQ(metrics.interface_rows, 15);
  EXPECT_EQ(metrics.interface_bodies, 6);
  EXPECT_EQ(metrics.interface_cover_bodies, 2);  // 0, then 4
  EXPECT_FALSE(metrics.contiguous);              // 0 and 5
  EXPECT_EQ(metrics.part_mass_ratio_max, 8);
}

TEST(Metrics, agree_with_counting_on_seeded_graphs) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Bodies bodies = random_bodies(seed);
    const BodyGraph graph = bodies.graph();
    Random random(seed + 4000);
    std::vector<Partition> partitions{random_partition(random, bodies.count())};
    const PartitionOptions options = random_partition_options(random);
    for (const PartitionerTwin& twin : partitioner_twins()) partitions.push_back(twin.run(graph, options));
    for (const Partition& partition : partitions) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << " (" << describe(bodies) << ")");
      expect_equal(metrics_by_counting(bodies, partition.part_of_body),
                   measure_partition(graph, partition.part_of_body));
      if (HasFailure()) return;
    }
  }
}

TEST(Metrics, cut_weight_agrees_with_counting) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Bodies bodies = random_bodies(seed);
    Random random(seed + 4000);
    const std::vector<int> part_of_body = random_partition(random, bodies.count()).part_of_body;
    for (const EdgeWeight unit : {EdgeWeight::pairs, EdgeWeight::constraints, EdgeWeight::rows}) {
      ASSERT_EQ(cut_weight(bodies.graph(), part_of_body, unit), counted_cut(bodies, part_of_body, unit))
          << "seed " << seed;
    }
  }
}

TEST(Metrics, of_no_bodies_and_of_one) {
  expect_equal(PartitionMetrics{}, measure_partition(BodyGraph(), {}));
  const PartitionMetrics metrics = measure_partition(Bodies{"", {3.0}, {{0, -1, 3}}}.graph(), std::vector{0});
  EXPECT_EQ(metrics.parts, 1);
  EXPECT_EQ(metrics.max_part_bodies, 1);
  EXPECT_EQ(metrics.interface_rows, 0);
  EXPECT_EQ(metrics.interface_cover_bodies, 0);
  EXPECT_TRUE(metrics.contiguous);
  EXPECT_EQ(metrics.part_mass_ratio_max, 1);
}

TEST(Metrics, part_sizes_counts_bodies_by_part) {
  EXPECT_EQ(part_sizes({{2, 0, 2, 1, 2}, 3}), (std::vector<int>{1, 1, 3}));
  EXPECT_EQ(part_sizes({}), std::vector<int>{});
}

TEST(Metrics, refuses_ids_that_are_no_partition) {
  const BodyGraph graph = six_bodies().graph();
  EXPECT_THROW(measure_partition(graph, std::vector{0, 0, 0, 0, 0}), std::invalid_argument);
  EXPECT_THROW(measure_partition(graph, std::vector{0, 0, 0, 0, 0, 0, 0}), std::invalid_argument);
  EXPECT_THROW(measure_partition(graph, std::vector{0, 0, -1, 0, 0, 0}), std::invalid_argument);
  EXPECT_THROW(measure_partition(graph, std::vector{0, 0, 6, 0, 0, 0}), std::invalid_argument);
}

}  // namespace
}  // namespace cleave::partition_test
