// What every partitioner and refiner of the registry must hold to, whichever they are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <ostream>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "partition/registry.h"
#include "tests/partition/brute_force.h"
#include "tests/partition/test_graphs.h"

namespace cleave {

// How GoogleTest prints the parameter of a failed test.
static void PrintTo(const PartitionerEntry& entry, std::ostream* out) { *out << entry.name; }
static void PrintTo(const RefinerEntry& entry, std::ostream* out) { *out << entry.name; }

}  // namespace cleave

namespace cleave::partition_test {
namespace {

constexpr std::uint64_t kSeeds = 120;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

class PartitionerContract : public testing::TestWithParam<PartitionerEntry> {};
class RefinerContract : public testing::TestWithParam<RefinerEntry> {};

TEST_P(PartitionerContract, grows_connected_bounded_parts_over_all_bodies) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Bodies bodies = random_bodies(seed);
    Random random(seed + 2000);
    const PartitionOptions options = random_partition_options(random);
    const Partition partition = GetParam().make()->run(bodies.graph(), options);
    ASSERT_EQ(grown_fault(bodies, partition, options.max_bodies), "")
        << "seed " << seed << " (" << describe(bodies) << "): " << describe(options);
  }
}

TEST_P(PartitionerContract, gives_the_same_partition_again) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const BodyGraph graph = random_bodies(seed).graph();
    Random random(seed + 2000);
    const PartitionOptions options = random_partition_options(random);
    const auto partitioner = GetParam().make();
    const Partition first = partitioner->run(graph, options);
    ASSERT_EQ(first_difference(first, partitioner->run(graph, options)), "") << "seed " << seed;
    ASSERT_EQ(first_difference(first, GetParam().make()->run(graph, options)), "") << "seed " << seed;
  }
}

TEST_P(PartitionerContract, ignores_static_geometry) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    Bodies bodies = random_bodies(seed);
    Random random(seed + 2000);
    const PartitionOptions options = random_partition_options(random);
    const Partition expected = GetParam().make()->run(bodies.graph(), options);
    for (int body = 0; body < bodies.count(); body += 2) bodies.links.push_back({body, -1, 3});
    ASSERT_EQ(first_difference(expected, GetParam().make()->run(bodies.graph(), options)), "")
        << "seed " << seed;
  }
}

TEST_P(PartitionerContract, accepts_the_smallest_graphs_and_the_largest_parts) {
  PartitionOptions options;
  EXPECT_EQ(GetParam().make()->run(BodyGraph(), options).part_count, 0);
  EXPECT_EQ(GetParam().make()->run(Bodies{"", {1.0}, {}}.graph(), options).part_count, 1);

  options.max_bodies = std::numeric_limits<int>::max();
  const Bodies triangle{"triangle", {1.0, 1.0, 1.0}, {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  EXPECT_EQ(GetParam().make()->run(triangle.graph(), options).part_count, 1);
  options.max_bodies = 1;
  EXPECT_EQ(GetParam().make()->run(triangle.graph(), options).part_count, 3);
}

// The message is one line that names the field and its value.
template <typename Run>
void expect_rejected(Run run, const std::string& field, const std::string& value) {
  try {
    run();
    ADD_FAILURE() << field << " = " << value << " was accepted";
  } catch (const std::invalid_argument& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find(field), std::string::npos) << message;
    EXPECT_NE(message.find(value), std::string::npos) << message << " lacks " << value;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

TEST_P(PartitionerContract, names_a_bad_option) {
  const BodyGraph graph = random_bodies(5).graph();
  const auto reject = [&](auto member, auto value, const std::string& field, const std::string& text) {
    PartitionOptions options;
    options.*member = value;
    expect_rejected([&] { GetParam().make()->run(graph, options); }, field, text);
  };
  reject(&PartitionOptions::max_bodies, 0, "max_bodies", "0");
  reject(&PartitionOptions::max_bodies, -7, "max_bodies", "-7");
  reject(&PartitionOptions::tau_mr, 1.0, "tau_mr", "1");
  reject(&PartitionOptions::tau_mr, 0.25, "tau_mr", "0.25");
  reject(&PartitionOptions::tau_mr, -12.5, "tau_mr", "-12.5");
  reject(&PartitionOptions::tau_mr, kNan, "tau_mr", "nan");
  reject(&PartitionOptions::tau_mix, 1.25, "tau_mix", "1.25");
  reject(&PartitionOptions::tau_mix, -0.25, "tau_mix", "-0.25");
  reject(&PartitionOptions::tau_mix, kNan, "tau_mix", "nan");
}

TEST_P(RefinerContract, keeps_all_parts_and_never_raises_the_cut) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Bodies bodies = random_bodies(seed);
    const BodyGraph graph = bodies.graph();
    Random random(seed + 3000);
    const PartitionOptions grow_options = random_partition_options(random);
    std::vector<Partition> starts{random_partition(random, bodies.count())};
    for (const PartitionerEntry& entry : partitioners())
      starts.push_back(entry.make()->run(graph, grow_options));
    for (const Partition& start : starts) {
      const RefineOptions options = random_refine_options(random);
      Partition refined = start;
      const RefineSummary summary = GetParam().make()->run(graph, options, refined);
      ASSERT_EQ(refined_fault(bodies, start, refined, options, summary), "")
          << "seed " << seed << " (" << describe(bodies) << "): " << describe(options);
      ASSERT_EQ(summary.exchanges == 0, first_difference(start, refined).empty()) << "seed " << seed;
    }
  }
}

TEST_P(RefinerContract, gives_the_same_partition_again) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const BodyGraph graph = random_bodies(seed).graph();
    Random random(seed + 3000);
    const Partition start = random_partition(random, graph.body_count());
    const RefineOptions options = random_refine_options(random);
    const auto refiner = GetParam().make();
    Partition first = start, again = start, anew = start;
    refiner->run(graph, options, first);
    refiner->run(graph, options, again);
    GetParam().make()->run(graph, options, anew);
    ASSERT_EQ(first_difference(first, again), "") << "seed " << seed;
    ASSERT_EQ(first_difference(first, anew), "") << "seed " << seed;
  }
}

TEST_P(RefinerContract, accepts_an_empty_graph_and_a_single_part) {
  Partition nothing;
  EXPECT_EQ(GetParam().make()->run(BodyGraph(), RefineOptions{}, nothing).exchanges, 0);
  const Bodies pair{"pair", {1.0, 1.0}, {{0, 1, 3}}};
  Partition one_part{{0, 0}, 1};
  EXPECT_EQ(GetParam().make()->run(pair.graph(), RefineOptions{}, one_part).exchanges, 0);
}

TEST_P(RefinerContract, names_a_bad_option) {
  const Bodies pair{"pair", {1.0, 1.0}, {{0, 1, 3}}};
  const BodyGraph graph = pair.graph();
  const auto reject = [&](auto member, auto value, const std::string& field, const std::string& text) {
    RefineOptions options;
    options.*member = value;
    Partition partition{{0, 1}, 2};
    expect_rejected([&] { GetParam().make()->run(graph, options, partition); }, field, text);
  };
  reject(&RefineOptions::max_bodies, 0, "max_bodies", "0");
  reject(&RefineOptions::max_bodies, -7, "max_bodies", "-7");
  reject(&RefineOptions::max_growth, -0.25, "max_growth", "-0.25");
  reject(&RefineOptions::max_growth, kNan, "max_growth", "nan");
}

TEST_P(RefinerContract, refuses_what_is_no_partition) {
  const Bodies pair{"pair", {1.0, 1.0}, {{0, 1, 3}}};
  for (const Partition& bad :
       {Partition{{0}, 1}, {{0, 1, 1}, 2}, {{0, 2}, 2}, {{0, -1}, 1}, {{0, 0}, 2}, {{1, 1}, 2}, {{}, 0}}) {
    Partition partition = bad;
    EXPECT_THROW(GetParam().make()->run(pair.graph(), RefineOptions{}, partition), std::invalid_argument)
        << testing::PrintToString(bad.part_of_body) << " in " << bad.part_count << " parts";
    EXPECT_EQ(first_difference(bad, partition), "");
  }
}

TEST(NoneRefiner, leaves_the_partition_alone) {
  for (const RefinerEntry& entry : refiners()) {
    if (std::string(entry.name) != "none") continue;
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      Random random(seed);
      const Bodies bodies = random_bodies(seed);
      const Partition start = random_partition(random, bodies.count());
      Partition partition = start;
      EXPECT_EQ(entry.make()->run(bodies.graph(), RefineOptions{}, partition).exchanges, 0);
      ASSERT_EQ(first_difference(start, partition), "") << "seed " << seed;
    }
    return;
  }
  ADD_FAILURE() << "none is not registered";
}

template <typename Entry>
void expect_good_rows(std::span<const Entry> table) {
  EXPECT_FALSE(table.empty());
  std::set<std::string> names;
  for (const Entry& entry : table) {
    EXPECT_TRUE(names.insert(entry.name).second) << entry.name << " twice";
    EXPECT_FALSE(std::string(entry.name).empty());
    EXPECT_FALSE(std::string(entry.help).empty()) << entry.name;
    EXPECT_EQ(std::string(entry.help).find('\n'), std::string::npos) << entry.name;
    EXPECT_FALSE(std::string(entry.reference).empty()) << entry.name;
    EXPECT_NE(entry.make(), nullptr) << entry.name;
  }
}

TEST(PartitionRegistry, has_unique_names_with_help_and_reference) {
  expect_good_rows(partitioners());
  expect_good_rows(refiners());
}

// Test names allow letters, digits and underscores only.
constexpr auto kEntryName = [](const auto& info) {
  std::string name = info.param.name;
  std::ranges::replace_if(
      name, [](unsigned char c) { return !std::isalnum(c); }, '_');
  return name;
};
INSTANTIATE_TEST_SUITE_P(All, PartitionerContract,
                         testing::ValuesIn(partitioners().begin(), partitioners().end()), kEntryName);
INSTANTIATE_TEST_SUITE_P(All, RefinerContract, testing::ValuesIn(refiners().begin(), refiners().end()),
                         kEntryName);

}  // namespace
}  // namespace cleave::partition_test
