// merge-small against its definition.
#include "partition/merge_small.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "partition/registry.h"
#include "tests/partition/printed_rows.h"
#include "tests/partition/slow_leftovers.h"
#include "tests/partition/test_graphs.h"

namespace cleave::partition_test {
namespace {

std::vector<PartitionerEntry> rows_with_merging() {
  std::vector<PartitionerEntry> rows;
  for (const PartitionerEntry& entry : partitioners())
    if (std::ranges::count(entry.parameters, "merge-small", &Parameter::name) > 0) rows.push_back(entry);
  return rows;
}

class MergeSmall : public testing::TestWithParam<PartitionerEntry> {
 protected:
  static Partition run(const BodyGraph& graph, int max_bodies, bool merges) {
    return make_partitioner(std::string(GetParam().name) + "@max-bodies=" + std::to_string(max_bodies) +
                            (merges ? "@merge-small=true" : ""))
        ->run(graph);
  }
};

TEST_P(MergeSmall, joins_what_its_definition_does) {
  int merged = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const Bodies bodies = random_bodies(seed);
    const int most = Random(seed + 5000).integer(1, 12);
    const LeftoverBounds bounds{
        .parts = static_cast<int>(std::ceil(static_cast<double>(bodies.count()) / most)),
        .small_bodies = static_cast<int>(std::ceil(most / 2.0)),
        .most_bodies = static_cast<int>(std::floor(1.2 * most + 1e-9))};
    Partition expected = run(bodies.graph(), most, false);
    merged += slow_join_leftovers(bodies, bounds, expected);
    ASSERT_EQ(first_difference(expected, run(bodies.graph(), most, true)), "")
        << "seed " << seed << " (" << describe(bodies) << "), max-bodies " << most;
  }
  EXPECT_GT(merged, 30);
}

TEST_P(MergeSmall, takes_the_smallest_graphs_and_the_largest_parts) {
  EXPECT_EQ(run(BodyGraph(), 3, true).part_count, 0);
  const Bodies pair{"pair", {1.0, 1.0}, {{0, 1, 3}}};
  EXPECT_EQ(run(pair.graph(), std::numeric_limits<int>::max(), true).part_count, 1);
  EXPECT_EQ(run(pair.graph(), 1, true).part_count, 2);
}

INSTANTIATE_TEST_SUITE_P(Growing, MergeSmall, testing::ValuesIn(rows_with_merging()),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(MergeSmallRows, are_those_that_grow) { EXPECT_EQ(rows_with_merging().size(), 5u); }

}  // namespace
}  // namespace cleave::partition_test
