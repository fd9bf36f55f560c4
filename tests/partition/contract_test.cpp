// What every partitioner and refiner of the registry must hold to, whichever they are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "harness/base/numbers.h"
#include "partition/registry.h"
#include "tests/partition/brute_force.h"
#include "tests/partition/printed_rows.h"
#include "tests/partition/test_graphs.h"

namespace cleave::partition_test {
namespace {

constexpr std::uint64_t kSeeds = 120;

// A row that cannot be made without more, or not in this build, is another test's.
std::vector<PartitionerEntry> rows_with_defaults() {
  std::vector<PartitionerEntry> rows;
  for (const PartitionerEntry& entry : partitioners())
    if (reason_to_leave_out(entry, {}).empty()) rows.push_back(entry);
  return rows;
}

std::string promise_fault(const Bodies& bodies, const Partition& partition, const PartitionerEntry& entry,
                          int max_bodies) {
  const int most_bodies = entry.promise.at_most_max_bodies ? max_bodies
                          : entry.promise.at_most_grown_bodies
                              ? max_bodies + max_bodies / 5  // the default growth
                              : bodies.count();
  if (entry.promise.contiguous) return grown_fault(bodies, partition, most_bodies);
  const std::string fault = ids_fault(bodies, partition);
  if (!fault.empty()) return fault;
  const std::vector<int> sizes = part_sizes(partition);
  const bool is_large = std::ranges::any_of(sizes, [&](int size) { return size > most_bodies; });
  return is_large ? "a part has more than " + std::to_string(most_bodies) + " bodies" : "";
}

class PartitionerContract : public testing::TestWithParam<PartitionerEntry> {};
class RefinerContract : public testing::TestWithParam<RefinerEntry> {};

// Whatever a row promises, and always one part for every body.
TEST_P(PartitionerContract, keeps_the_promises_of_its_row) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Bodies bodies = random_bodies(seed);
    Random random(seed + 2000);
    const PartitionOptions options = random_partition_options(random);
    const Partition partition = run(GetParam(), bodies.graph(), options);
    ASSERT_EQ(promise_fault(bodies, partition, GetParam(), options.max_bodies), "")
        << "seed " << seed << " (" << describe(bodies) << "): " << describe(options);
  }
}

TEST_P(PartitionerContract, gives_the_same_partition_again) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const BodyGraph graph = random_bodies(seed).graph();
    Random random(seed + 2000);
    const PartitionOptions options = random_partition_options(random);
    const auto partitioner = make_partitioner(algorithm_of(GetParam(), options));
    const Partition first = partitioner->run(graph);
    ASSERT_EQ(first_difference(first, partitioner->run(graph)), "") << "seed " << seed;
    ASSERT_EQ(first_difference(first, run(GetParam(), graph, options)), "") << "seed " << seed;
  }
}

TEST_P(PartitionerContract, ignores_static_geometry) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    Bodies bodies = random_bodies(seed);
    Random random(seed + 2000);
    const PartitionOptions options = random_partition_options(random);
    const Partition expected = run(GetParam(), bodies.graph(), options);
    for (int body = 0; body < bodies.count(); body += 2) bodies.links.push_back({body, -1, 3});
    ASSERT_EQ(first_difference(expected, run(GetParam(), bodies.graph(), options)), "") << "seed " << seed;
  }
}

TEST_P(PartitionerContract, accepts_the_smallest_graphs_and_the_largest_parts) {
  PartitionOptions options;
  EXPECT_EQ(run(GetParam(), BodyGraph(), options).part_count, 0);
  EXPECT_EQ(run(GetParam(), Bodies{"", {1.0}, {}}.graph(), options).part_count, 1);

  if (!GetParam().promise.at_most_max_bodies) return;
  options.max_bodies = std::numeric_limits<int>::max();
  const Bodies triangle{"triangle", {1.0, 1.0, 1.0}, {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  EXPECT_EQ(run(GetParam(), triangle.graph(), options).part_count, 1);
  options.max_bodies = 1;
  EXPECT_EQ(run(GetParam(), triangle.graph(), options).part_count, 3);
}

// What a row does not promise is not checked of it; each promise is made by somebody.
TEST(PartitionerPromises, each_is_checked_of_somebody) {
  int contiguous = 0, at_most_max_bodies = 0, at_most_grown_bodies = 0, in_order = 0;
  for (const PartitionerEntry& entry : partitioners()) {
    contiguous += entry.promise.contiguous;
    at_most_max_bodies += entry.promise.at_most_max_bodies;
    at_most_grown_bodies += entry.promise.at_most_grown_bodies;
    in_order += entry.promise.grown_in_order;
  }
  EXPECT_GE(contiguous, 5);
  EXPECT_GE(at_most_max_bodies, 5);
  EXPECT_GE(at_most_grown_bodies, 1);
  EXPECT_GE(in_order, 4);
}

// The message is one line that names the parameter and its value.
template <typename Run>
void expect_rejected(Run run, const std::string& parameter, const std::string& value) {
  try {
    run();
    ADD_FAILURE() << parameter << " = " << value << " was accepted";
  } catch (const std::invalid_argument& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find(parameter), std::string::npos) << message;
    EXPECT_NE(message.find(value), std::string::npos) << message << " lacks " << value;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

// Values outside what a declaration allows.
std::vector<std::string> bad_values(const Parameter& parameter) {
  using Kind = Parameter::Kind;
  if (parameter.kind == Kind::path) return {""};
  if (parameter.kind == Kind::word || parameter.kind == Kind::flag) return {"nonsense", ""};
  std::vector<std::string> bad = {"nan", "nonsense", "1x", ""};
  if (std::isfinite(parameter.range.min)) bad.push_back(number_text(parameter.range.min - 1));
  if (std::isfinite(parameter.range.max)) bad.push_back(number_text(parameter.range.max + 1));
  if (parameter.range.min_open) bad.push_back(number_text(parameter.range.min));
  return bad;
}

template <class Entry, class Make>
void expect_bad_values_rejected(const Entry& entry, Make make) {
  for (const Parameter& parameter : entry.parameters)
    for (const std::string& value : bad_values(parameter))
      expect_rejected([&] { make(std::string(entry.name) + "@" + parameter.name + "=" + value); },
                      parameter.name, value);
}

TEST_P(PartitionerContract, names_a_bad_value_of_every_parameter) {
  expect_bad_values_rejected(GetParam(), [](const std::string& text) { make_partitioner(text); });
}

TEST_P(RefinerContract, names_a_bad_value_of_every_parameter) {
  expect_bad_values_rejected(GetParam(), [](const std::string& text) { make_refiner(text); });
}

TEST(PartitionRegistry, a_parameter_of_another_row_is_an_error_that_names_its_owner) {
  expect_rejected([] { make_partitioner("mindp@tau-mr=5"); }, "tau-mr is a parameter of mr", "mindp has:");
  expect_rejected([] { make_partitioner("mindp@max-body=5"); }, "'max-bodies'?", "'max-body'");
  expect_rejected([] { make_refiner("kl@max-growth=0"); }, "max-growth is a parameter of fm", "kl has:");
  expect_rejected([] { make_partitioner("geometric@trials=5"); }, "trials is a parameter of karger",
                  "geometric has:");
  expect_rejected([] { make_partitioner("mindp@max-bodies"); }, "name@parameter=value", "'@max-bodies'");
  expect_rejected([] { make_partitioner("mindp@max-bodies=5@max-bodies=6"); }, "max-bodies", "twice");
  expect_rejected([] { make_partitioner("mindq"); }, "'mindq'", "'mindp'");
}

// Columns, options and attributes are called after parameters, so one name must mean one thing.
TEST(PartitionRegistry, rows_that_share_a_parameter_share_its_declaration) {
  std::map<std::string, Parameter> known;
  const auto look = [&](const auto& table) {
    for (const auto& entry : table)
      for (const Parameter& parameter : entry.parameters) {
        const Parameter& first = known.emplace(parameter.name, parameter).first->second;
        EXPECT_EQ(first.default_value, parameter.default_value) << entry.name << " " << parameter.name;
        EXPECT_EQ(first.help, parameter.help) << entry.name << " " << parameter.name;
        EXPECT_EQ(allowed_text(first), allowed_text(parameter)) << entry.name << " " << parameter.name;
      }
  };
  look(partitioners());
  look(refiners());
  EXPECT_GE(known.size(), 8u);
}

TEST_P(RefinerContract, keeps_all_parts_and_never_raises_the_cut) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Bodies bodies = random_bodies(seed);
    const BodyGraph graph = bodies.graph();
    Random random(seed + 3000);
    const PartitionOptions grow_options = random_partition_options(random);
    std::vector<Partition> starts{random_partition(random, bodies.count())};
    for (const PartitionerEntry& entry : rows_with_defaults())
      starts.push_back(run(entry, graph, grow_options));
    for (const Partition& start : starts) {
      const RefineOptions options = options_of(GetParam(), random_refine_options(random));
      Partition refined = start;
      const RefineSummary summary = run(GetParam(), graph, options, refined);
      ASSERT_EQ(refined_fault(bodies, start, refined, options, summary, GetParam().traits.may_raise_cut), "")
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
    const auto refiner = make_refiner(algorithm_of(GetParam(), options));
    Partition first = start, again = start, anew = start;
    refiner->run(graph, options.max_bodies, first);
    refiner->run(graph, options.max_bodies, again);
    run(GetParam(), graph, options, anew);
    ASSERT_EQ(first_difference(first, again), "") << "seed " << seed;
    ASSERT_EQ(first_difference(first, anew), "") << "seed " << seed;
  }
}

TEST_P(RefinerContract, accepts_an_empty_graph_and_a_single_part) {
  Partition nothing;
  EXPECT_EQ(run(GetParam(), BodyGraph(), RefineOptions{}, nothing).exchanges, 0);
  const Bodies pair{"pair", {1.0, 1.0}, {{0, 1, 3}}};
  Partition one_part{{0, 0}, 1};
  EXPECT_EQ(run(GetParam(), pair.graph(), RefineOptions{}, one_part).exchanges, 0);
}

TEST_P(RefinerContract, refuses_parts_of_no_body) {
  const Bodies pair{"pair", {1.0, 1.0}, {{0, 1, 3}}};
  for (const int max_bodies : {0, -7}) {
    RefineOptions options;
    options.max_bodies = max_bodies;
    Partition partition{{0, 1}, 2};
    expect_rejected([&] { run(GetParam(), pair.graph(), options, partition); }, "max_bodies",
                    std::to_string(max_bodies));
  }
}

TEST_P(RefinerContract, refuses_what_is_no_partition) {
  const Bodies pair{"pair", {1.0, 1.0}, {{0, 1, 3}}};
  for (const Partition& bad :
       {Partition{{0}, 1}, {{0, 1, 1}, 2}, {{0, 2}, 2}, {{0, -1}, 1}, {{0, 0}, 2}, {{1, 1}, 2}, {{}, 0}}) {
    Partition partition = bad;
    EXPECT_THROW(run(GetParam(), pair.graph(), RefineOptions{}, partition), std::invalid_argument)
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
      EXPECT_EQ(run(entry, bodies.graph(), RefineOptions{}, partition).exchanges, 0);
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
INSTANTIATE_TEST_SUITE_P(All, PartitionerContract, testing::ValuesIn(rows_with_defaults()), kEntryName);
INSTANTIATE_TEST_SUITE_P(All, RefinerContract, testing::ValuesIn(refiners().begin(), refiners().end()),
                         kEntryName);

}  // namespace
}  // namespace cleave::partition_test
