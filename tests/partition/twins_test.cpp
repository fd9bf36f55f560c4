// Fast = slow twin, for every partitioner and refiner, on 500 seeded graphs and a few piles of real size.
#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "partition/registry.h"
#include "tests/partition/slow_twins.h"
#include "tests/partition/test_graphs.h"

namespace cleave::partition_test {

// How GoogleTest prints the parameter of a failed test.
static void PrintTo(const PartitionerTwin& twin, std::ostream* out) { *out << twin.name; }
static void PrintTo(const RefinerTwin& twin, std::ostream* out) { *out << twin.name; }

namespace {

constexpr std::uint64_t kSeeds = 500;
constexpr int kDrawsPerSeed = 3;

// The entry of that name in a registry table; the test fails if there is none.
template <typename Entry>
const Entry* registered(std::span<const Entry> table, const std::string& name) {
  for (const Entry& entry : table) {
    if (name == entry.name) return &entry;
  }
  ADD_FAILURE() << name << " is not registered";
  return nullptr;
}

// "" if the fast partitioner and its twin agree.
std::string difference(const PartitionerEntry& fast, const PartitionerTwin& twin, const BodyGraph& graph,
                       const PartitionOptions& options) {
  return first_difference(twin.run(graph, options), run(fast, graph, options));
}

std::string difference(const RefinerEntry& fast, const RefinerTwin& twin, const BodyGraph& graph,
                       const RefineOptions& drawn, const Partition& start) {
  const RefineOptions options = options_of(fast, drawn);
  Partition expected = start;
  Partition actual = start;
  const RefineSummary expected_summary = twin.run(graph, options, expected);
  const RefineSummary summary = run(fast, graph, options, actual);
  if (const std::string text = first_difference(expected, actual); !text.empty()) return text;
  std::ostringstream text;
  const auto compare = [&](const char* field, long expected_value, long value) {
    if (expected_value != value)
      text << field << ": expected " << expected_value << ", got " << value << "; ";
  };
  compare("exchanges", expected_summary.exchanges, summary.exchanges);
  compare("cut_before", expected_summary.cut_before, summary.cut_before);
  compare("cut_after", expected_summary.cut_after, summary.cut_after);
  return text.str();
}

// Starting partitions for the refiners: one from every partitioner and one dealt at random.
struct Start {
  std::string from;
  Partition partition;
};

std::vector<Start> starts(Random& random, const BodyGraph& graph) {
  const PartitionOptions options = random_partition_options(random);
  std::vector<Start> result;
  for (const PartitionerTwin& twin : partitioner_twins()) {
    result.push_back({std::string(twin.name) + " with " + describe(options), twin.run(graph, options)});
  }
  result.push_back({"random", random_partition(random, graph.body_count())});
  return result;
}

// The twins of those that climb hills keep every moment of a pass, that of fm-cost counts every candidate
// from scratch.
std::uint64_t seeds_of(const RefinerTwin& twin) {
  const std::string name = twin.name;
  return name.ends_with("-hill") || name == "fm-cost" ? kSeeds / 5 : kSeeds;
}

class PartitionerTwins : public testing::TestWithParam<PartitionerTwin> {};
class RefinerTwins : public testing::TestWithParam<RefinerTwin> {};

TEST_P(PartitionerTwins, agree_on_seeded_graphs) {
  const PartitionerEntry* fast = registered(partitioners(), GetParam().name);
  ASSERT_NE(fast, nullptr);
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Bodies bodies = random_bodies(seed);
    const BodyGraph graph = bodies.graph();
    Random random(seed + 1000);
    for (int draw = 0; draw < kDrawsPerSeed; ++draw) {
      const PartitionOptions options = random_partition_options(random);
      ASSERT_EQ(difference(*fast, GetParam(), graph, options), "")
          << "seed " << seed << " (" << describe(bodies) << "), draw " << draw << ": " << describe(options);
    }
  }
}

TEST_P(PartitionerTwins, agree_on_a_pile_of_600_bodies) {
  const PartitionerEntry* fast = registered(partitioners(), GetParam().name);
  ASSERT_NE(fast, nullptr);
  Random random(1);
  const Bodies bodies = pile(random, 10, 10, 6);
  PartitionOptions options;
  for (const bool as_printed : {false, true}) {
    options.as_printed = as_printed;
    EXPECT_EQ(difference(*fast, GetParam(), bodies.graph(), options), "") << describe(options);
  }
}

TEST_P(RefinerTwins, agree_on_seeded_graphs) {
  const RefinerEntry* fast = registered(refiners(), GetParam().name);
  ASSERT_NE(fast, nullptr);
  for (std::uint64_t seed = 0; seed < seeds_of(GetParam()); ++seed) {
    const Bodies bodies = random_bodies(seed);
    const BodyGraph graph = bodies.graph();
    Random random(seed + 1000);
    for (const Start& start : starts(random, graph)) {
      const RefineOptions options = random_refine_options(random);
      ASSERT_EQ(difference(*fast, GetParam(), graph, options, start.partition), "")
          << "seed " << seed << " (" << describe(bodies) << "), start " << start.from << ": "
          << describe(options);
    }
  }
}

TEST_P(RefinerTwins, agree_on_a_pile) {
  const RefinerEntry* fast = registered(refiners(), GetParam().name);
  ASSERT_NE(fast, nullptr);
  Random random(2);
  const bool is_slow = seeds_of(GetParam()) < kSeeds;
  const Bodies bodies = is_slow ? pile(random, 5, 5, 5) : pile(random, 10, 10, 6);
  const BodyGraph graph = bodies.graph();
  for (const PartitionerTwin& twin : partitioner_twins()) {
    const Partition start = twin.run(graph, PartitionOptions{});
    EXPECT_EQ(difference(*fast, GetParam(), graph, RefineOptions{}, start), "") << "start " << twin.name;
  }
}

constexpr auto kTwinName = [](const auto& info) {
  std::string name = info.param.name;
  std::ranges::replace(name, '-', '_');
  return name;
};
INSTANTIATE_TEST_SUITE_P(All, PartitionerTwins,
                         testing::ValuesIn(partitioner_twins().begin(), partitioner_twins().end()),
                         kTwinName);
INSTANTIATE_TEST_SUITE_P(All, RefinerTwins, testing::ValuesIn(refiner_twins().begin(), refiner_twins().end()),
                         kTwinName);

}  // namespace
}  // namespace cleave::partition_test
