// merge-small against its definition.
#include "partition/merge_small.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "partition/leftovers.h"
#include "partition/registry.h"
#include "tests/partition/printed_rows.h"
#include "tests/partition/slow_mending.h"
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

TEST_P(MergeSmall, mends_as_its_definition_does) {
  int mended = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const Bodies bodies = random_bodies(seed);
    const int most = Random(seed + 5000).integer(1, 12);
    const Partition grown = run(bodies.graph(), most, false);
    const Partition expected = slow_mend(bodies, most, grown);
    mended += !first_difference(grown, expected).empty();
    ASSERT_EQ(first_difference(expected, run(bodies.graph(), most, true)), "")
        << "seed " << seed << " (" << describe(bodies) << "), max-bodies " << most;
  }
  EXPECT_GT(mended, 30);
}

TEST_P(MergeSmall, keeps_its_bound_and_cuts_no_more_than_joined_crumbs) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const BodyGraph graph = random_bodies(seed).graph();
    const int most = Random(seed + 5000).integer(1, 12), wanted = wanted_parts(graph.body_count(), most);
    Partition joined = run(graph, most, false);
    join_leftovers(graph, {wanted, most / 2 + most % 2, most_merged_bodies(most)}, joined);
    const Partition parts = run(graph, most, true);
    const long cut = cut_weight(graph, parts.part_of_body, EdgeWeight::rows);
    ASSERT_LE(cut, cut_weight(graph, joined.part_of_body, EdgeWeight::rows)) << "seed " << seed;
    ASSERT_LE(wanted, parts.part_count);
    ASSERT_LE(parts.part_count, joined.part_count);
    ASSERT_EQ(find_broken_promise(graph, parts, {.at_most_max_bodies = true}, most_merged_bodies(most)), "");
    ASSERT_EQ(first_difference(parts, run(graph, most, true)), "") << "seed " << seed;
  }
}

// Five of 20 bodies are more than k = 4, and no two have room in one part of 30.
TEST_P(MergeSmall, leaves_what_would_cut_more_in_fewer_parts) {
  Bodies islands{"islands", std::vector<double>(100, 1.0), {}};
  for (int body = 0; body < 100; ++body)
    if (body % 20 != 19) islands.links.push_back({body, body + 1, 3});
  const Partition parts = run(islands.graph(), 25, true);
  EXPECT_EQ(parts.part_count, 5);
  EXPECT_EQ(cut_weight(islands.graph(), parts.part_of_body, EdgeWeight::rows), 0);
}

// Growing leaves half as many parts again, and what only joins them some.
TEST_P(MergeSmall, makes_as_many_parts_of_a_pile_as_are_wanted_and_cuts_less) {
  Random random(3);
  const BodyGraph graph = pile(random, 10, 10, 6).graph();
  const Partition grown = run(graph, 25, false), parts = run(graph, 25, true);
  EXPECT_GT(grown.part_count, 24);
  EXPECT_EQ(parts.part_count, 24);
  EXPECT_LT(cut_weight(graph, parts.part_of_body, EdgeWeight::rows),
            0.9 * static_cast<double>(cut_weight(graph, grown.part_of_body, EdgeWeight::rows)));
}

TEST_P(MergeSmall, takes_work_that_is_nearly_linear) {
  std::vector<double> work;  // gains a body
  for (const int side : {16, 40}) {
    Random random(4);
    const Bodies bodies = pile(random, side, side, 10);
    Partition parts = run(bodies.graph(), 25, false);
    work.push_back(static_cast<double>(mend(bodies.graph(), 25, parts)) / bodies.count());
  }
  EXPECT_LT(work[1], 1.3 * work[0]);
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
