// The seeded graphs and options must tell a wrong algorithm from a right one: here twins with other ties, and
// twins that read an option differently, have to be noticed.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "tests/partition/slow_twins.h"
#include "tests/partition/test_graphs.h"

namespace cleave::partition_test {
namespace {

constexpr std::uint64_t kSeeds = 500;

// The twin on mirrored indices: the same algorithm with ties to the highest body.
Partition with_highest_ties(const PartitionerTwin& twin, const Bodies& bodies,
                            const PartitionOptions& options) {
  return reversed(twin.run(reversed(bodies).graph(), options));
}

Partition with_highest_ties(const RefinerTwin& twin, const Bodies& bodies, const RefineOptions& options,
                            const Partition& start) {
  Partition partition = reversed(start);
  twin.run(reversed(bodies).graph(), options, partition);
  return reversed(partition);
}

// On how many seeds a variant of an algorithm gives another partition.
int seeds_that_differ(const std::function<bool(const Bodies&, Random&)>& differs) {
  int count = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    Random random(seed + 1000);
    count += differs(random_bodies(seed), random);
  }
  return count;
}

TEST(SeededGraphs, tell_a_partitioner_with_other_ties) {
  for (const PartitionerTwin& twin : partitioner_twins()) {
    const int seeds = seeds_that_differ([&](const Bodies& bodies, Random& random) {
      const PartitionOptions options = random_partition_options(random);
      return !first_difference(twin.run(bodies.graph(), options), with_highest_ties(twin, bodies, options))
                  .empty();
    });
    EXPECT_GE(seeds, 100) << twin.name;
  }
}

TEST(SeededGraphs, tell_a_refiner_with_other_ties) {
  for (const RefinerTwin& twin : refiner_twins()) {
    const int seeds = seeds_that_differ([&](const Bodies& bodies, Random& random) {
      const RefineOptions options = random_refine_options(random);
      const Partition start = random_partition(random, bodies.count());
      Partition expected = start;
      twin.run(bodies.graph(), options, expected);
      return !first_difference(expected, with_highest_ties(twin, bodies, options, start)).empty();
    });
    if (std::string(twin.name) == "none") {
      EXPECT_EQ(seeds, 0);
    } else {
      EXPECT_GE(seeds, 100) << twin.name;
    }
  }
}

// Partitioners that must notice the change of an option.
struct OptionCase {
  const char* option;
  std::vector<std::string> partitioners;
  void (*change)(PartitionOptions&);
};

TEST(SeededGraphs, tell_a_partitioner_that_ignores_an_option) {
  const OptionCase cases[] = {
      {"max_bodies", {"mindp", "maxdp", "bfs", "mr", "mix"}, [](PartitionOptions& o) { ++o.max_bodies; }},
      {"tau_mr", {"mr"}, [](PartitionOptions& o) { o.tau_mr = o.tau_mr == 10 ? 10.5 : 10; }},
      {"tau_mix", {"mix"}, [](PartitionOptions& o) { o.tau_mix = 1 - 0.9 * o.tau_mix; }},
      {"edge_weight",
       {"mix"},
       [](PartitionOptions& o) {
         o.edge_weight = o.edge_weight == EdgeWeight::rows ? EdgeWeight::pairs : EdgeWeight::rows;
       }},
      {"degree",
       {"mindp", "maxdp", "mix"},
       [](PartitionOptions& o) {
         o.degree = o.degree == DegreeUnit::bodies ? DegreeUnit::constraints : DegreeUnit::bodies;
       }},
      {"degree_scope",
       {"mindp", "maxdp", "mix"},
       [](PartitionOptions& o) {
         o.degree_scope = o.degree_scope == DegreeScope::left ? DegreeScope::whole : DegreeScope::left;
       }},
      {"as_printed", {"maxdp", "mix"}, [](PartitionOptions& o) { o.as_printed = !o.as_printed; }},
  };
  for (const OptionCase& option_case : cases) {
    for (const PartitionerTwin& twin : partitioner_twins()) {
      const int seeds = seeds_that_differ([&](const Bodies& bodies, Random& random) {
        const PartitionOptions options = random_partition_options(random);
        PartitionOptions changed = options;
        option_case.change(changed);
        return !first_difference(twin.run(bodies.graph(), options), twin.run(bodies.graph(), changed))
                    .empty();
      });
      if (std::ranges::count(option_case.partitioners, twin.name) > 0) {
        EXPECT_GE(seeds, 20) << twin.name << ", " << option_case.option;
      } else {
        EXPECT_EQ(seeds, 0) << twin.name << " has no business with " << option_case.option;
      }
    }
  }
}

TEST(SeededGraphs, tell_fm_with_another_bound_or_unit) {
  const RefinerTwin& fm = refiner_twins()[2];
  ASSERT_EQ(std::string(fm.name), "fm");
  const auto seeds_with = [&](void (*change)(RefineOptions&)) {
    return seeds_that_differ([&](const Bodies& bodies, Random& random) {
      const RefineOptions options = random_refine_options(random);
      RefineOptions changed = options;
      change(changed);
      const Partition start =
          partitioner_twins()[0].run(bodies.graph(), PartitionOptions{.max_bodies = options.max_bodies});
      Partition expected = start;
      Partition other = start;
      fm.run(bodies.graph(), options, expected);
      fm.run(bodies.graph(), changed, other);
      return !first_difference(expected, other).empty();
    });
  };
  EXPECT_GE(seeds_with([](RefineOptions& o) { ++o.max_bodies; }), 20);
  EXPECT_GE(seeds_with([](RefineOptions& o) { o.max_growth += 0.5; }), 20);
  EXPECT_GE(seeds_with([](RefineOptions& o) { o.as_printed = !o.as_printed; }), 20);
}

}  // namespace
}  // namespace cleave::partition_test
