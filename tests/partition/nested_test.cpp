// Trees of parts: what they must be whoever splits the sets, and the recursion against its slow twin.
#include "partition/nested.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include "partition/registry.h"
#include "tests/partition/printed_rows.h"
#include "tests/partition/slow_nested.h"
#include "tests/partition/test_graphs.h"
#include "tests/partition/tree_fault.h"

namespace cleave::partition_test {
namespace {

constexpr std::uint64_t kSeeds = 120;
constexpr double kDefaultGrowth = 0.2;  // of partitioners whose parts may grow, which the draws leave alone

bool takes(const auto& entry, const std::string& parameter) {
  return std::ranges::count(entry.parameters, parameter, &Parameter::name) > 0;
}

std::vector<PartitionerEntry> rows_that_split_by_recursion() {
  std::vector<PartitionerEntry> rows;
  for (const PartitionerEntry& entry : partitioners())
    if (entry.unavailable.empty() && takes(entry, "max-bodies")) rows.push_back(entry);
  return rows;
}

Partition nest(const BodyGraph& graph, const SetSplitter& splitter) {
  const auto split_set = [&](const BodyGraph& set, int most_bodies) {
    Partition parts = splitter.grow(set, most_bodies);
    splitter.refine(set, most_bodies, parts);
    return parts;
  };
  return split_by_recursion(graph, splitter.max_bodies(), splitter.arity(), split_set);
}

// What is drawn for one seed.
struct Draw {
  explicit Draw(std::uint64_t seed) : bodies(random_bodies(seed)) {
    Random random(seed + 7000);
    grown = random_partition_options(random);
    refined = random_refine_options(random);
    refined.max_bodies = grown.max_bodies;
    arity = random.integer(2, 5);
    text = "seed " + std::to_string(seed) + " (" + describe(bodies) + "), arity " + std::to_string(arity) +
           ": " + describe(grown) + "; " + describe(refined);
  }
  SetSplitter splitter(const PartitionerEntry& partitioner, const RefinerEntry& refiner) const {
    return {algorithm_of(partitioner, grown), algorithm_of(refiner, refined), arity};
  }

  Bodies bodies;
  PartitionOptions grown;
  RefineOptions refined;
  int arity;
  std::string text;
};

class NestedContract : public testing::TestWithParam<std::tuple<PartitionerEntry, RefinerEntry>> {
 protected:
  static const PartitionerEntry& partitioner() { return std::get<0>(GetParam()); }
  static const RefinerEntry& refiner() { return std::get<1>(GetParam()); }

  static bool is_bounded() {
    return partitioner().promise.at_most_max_bodies || partitioner().promise.at_most_grown_bodies;
  }

  // Bodies that a leaf may have: a set with more is split, but children that were to have no more than
  // max_bodies are leaves as their refiner left them, and sets that were left whole are leaves.
  static int most_leaf_bodies(const Draw& draw) {
    if (!is_bounded() || (takes(refiner(), "as-printed") && draw.refined.as_printed))
      return draw.bodies.count();
    const auto grown = [&](double growth) {
      return static_cast<int>(std::floor((1 + growth) * draw.grown.max_bodies + 1e-9));
    };
    int most = draw.grown.max_bodies;
    if (takes(refiner(), "max-growth")) most = std::max(most, grown(draw.refined.max_growth));
    if (takes(partitioner(), "max-growth")) most = std::max(most, grown(kDefaultGrowth));
    return most;
  }
};

TEST_P(NestedContract, gives_a_tree_whose_leaves_are_small) {
  int deep = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Draw draw(seed);
    const Partition nested = nest(draw.bodies.graph(), draw.splitter(partitioner(), refiner()));
    ASSERT_EQ(tree_fault(draw.bodies, nested), "") << draw.text;
    for (const int size : part_sizes(nested)) ASSERT_LE(size, most_leaf_bodies(draw)) << draw.text;
    const int inner = static_cast<int>(nested.parent_of_part.size()) - nested.part_count;
    const bool must_split = is_bounded() && draw.bodies.count() > most_leaf_bodies(draw);
    ASSERT_TRUE(inner > 0 || !must_split) << draw.text;
    ASSERT_TRUE(inner == 0 || draw.bodies.count() > draw.grown.max_bodies) << draw.text;
    deep += inner > 2;
  }
  // Groups that stay whole make no deeper tree than the groups.
  EXPECT_TRUE(deep > 10 || takes(partitioner(), "split")) << deep;
}

TEST_P(NestedContract, gives_the_same_tree_again) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Draw draw(seed);
    const BodyGraph graph = draw.bodies.graph();
    const SetSplitter splitter = draw.splitter(partitioner(), refiner());
    const Partition first = nest(graph, splitter);
    for (const Partition& other :
         {nest(graph, splitter), nest(graph, draw.splitter(partitioner(), refiner()))}) {
      ASSERT_EQ(first_difference(first, other), "") << draw.text;
      ASSERT_EQ(first.parent_of_part, other.parent_of_part) << draw.text;
    }
  }
}

TEST_P(NestedContract, accepts_the_smallest_graphs_and_the_largest_arity) {
  const auto algorithm = [](const auto& entry, int max_bodies) {
    return Algorithm{entry.name, entry.name, [&] {
                       auto values = defaults_of(entry).values();
                       if (values.contains("max-bodies")) values["max-bodies"] = std::to_string(max_bodies);
                       return Settings(values);
                     }()};
  };
  const auto nested = [&](const Bodies& bodies, int max_bodies, int arity) {
    return nest(bodies.graph(),
                SetSplitter(algorithm(partitioner(), max_bodies), algorithm(refiner(), max_bodies), arity));
  };
  const Bodies triangle{"triangle", {1.0, 1.0, 1.0}, {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  const Bodies loose{"loose", {1.0, 1.0, 1.0, 1.0}, {}};
  using Parents = std::vector<int>;
  EXPECT_EQ(nested({}, 1, 2).parent_of_part, Parents());
  EXPECT_EQ(nested({"one", {1.0}, {}}, 1, 2).parent_of_part, Parents{-1});
  EXPECT_EQ(nested(triangle, 3, 2).parent_of_part, Parents{-1});
  EXPECT_EQ(nested(triangle, std::numeric_limits<int>::max(), 2).parent_of_part, Parents{-1});
  if (partitioner().promise.at_most_max_bodies) {
    const Parents parents = nested(triangle, 1, std::numeric_limits<int>::max()).parent_of_part;
    EXPECT_EQ(parents, (Parents{3, 3, 3, -1}));
  }
  EXPECT_EQ(tree_fault(loose, nested(loose, 2, 2)), "");
}

// The check of trees must be able to fail: each tree is wrong in one way.
TEST(TreeFault, tells_what_is_wrong_with_a_tree) {
  const Bodies four{"four", {1, 1, 1, 1}, {{0, 1, 3}}};
  const auto fault = [&](std::vector<int> parent_of_part, std::vector<int> part_of_body = {0, 1, 1, 2},
                         int parts = 3) {
    return tree_fault(four, {std::move(part_of_body), parts, {}, std::move(parent_of_part)});
  };
  EXPECT_EQ(fault({3, 3, 4, 4, -1}), "");
  EXPECT_EQ(fault({3, 3, 3, -1}), "");
  EXPECT_NE(fault({}), "");
  EXPECT_NE(fault({3, 3, -1, -1}), "");                     // two roots
  EXPECT_NE(fault({3, 3, 4, 5, 5, -1}), "");                // an only child
  EXPECT_NE(fault({4, 4, 3, -1, 3}), "");                   // a parent before its child
  EXPECT_NE(fault({2, 2, 4, 4, -1}), "");                   // a part that is no leaf
  EXPECT_NE(fault({4, 4, 4, 4, -1}), "");                   // an inner node without children
  EXPECT_NE(fault({4, 4, 4, 4, -1}, {0, 1, 1, 3}, 4), "");  // an empty part
  EXPECT_NE(fault({4, 4, 4, -1, -1}), "");                  // two trees
  EXPECT_NE(tree_fault(Bodies{}, {{}, 0, {}, {-1}}), "");   // a node of nothing
}

// Every pair of twins, on the same draws.
TEST(NestedTwin, agrees_with_the_recursion) {
  int nodes = 0, joined = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Draw draw(seed);
    const BodyGraph graph = draw.bodies.graph();
    for (const PartitionerTwin& partitioner : partitioner_twins()) {
      for (const RefinerTwin& refiner : refiner_twins()) {
        const auto row = [](const auto& table, const std::string& name) {
          return *std::ranges::find(table, name, [](const auto& entry) { return std::string(entry.name); });
        };
        const RefinerEntry refiner_row = row(refiners(), refiner.name);
        const RefineOptions refined = options_of(refiner_row, draw.refined);
        const SlowNested twin =
            slow_nested(draw.bodies, partitioner, draw.grown, refiner, refined, draw.arity);
        const Partition fast = nest(graph, draw.splitter(row(partitioners(), partitioner.name), refiner_row));
        SCOPED_TRACE(draw.text + ", " + partitioner.name + "+" + refiner.name);
        ASSERT_EQ(first_difference(twin.nested, fast), "");
        ASSERT_EQ(twin.nested.parent_of_part, fast.parent_of_part);
        nodes += static_cast<int>(fast.parent_of_part.size());
        joined += twin.joined;
      }
    }
  }
  EXPECT_GT(nodes, 10000);
  EXPECT_GT(joined, 1000);
}

// Splits off one body at a time, which makes the deepest tree there is.
TEST(Nested, takes_sets_that_lose_one_body_at_a_time) {
  constexpr int kBodies = 3000;
  const Bodies bodies{"loose", std::vector<double>(kBodies, 1.0), {}};
  const Partition nested = split_by_recursion(bodies.graph(), 1, 2, [](const BodyGraph& set, int) {
    Partition parts{std::vector<int>(set.body_count(), 0), 2};
    parts.part_of_body.back() = 1;
    return parts;
  });
  ASSERT_EQ(nested.part_count, kBodies);
  ASSERT_EQ(nested.parent_of_part.size(), 2u * kBodies - 1);
  // The first child of the first child ... is body 0; each inner node has the next one up as its parent.
  EXPECT_EQ(nested.part_of_body.front(), 0);
  for (int inner = kBodies; inner < 2 * kBodies - 2; ++inner)
    ASSERT_EQ(nested.parent_of_part[inner], inner + 1);
}

// By hand: a path of eight bodies, halved until two are left. Leaves in order of creation, inner nodes
// backwards.
TEST(Nested, numbers_nodes_as_they_are_made) {
  const Bodies path{"path",
                    std::vector<double>(8, 1.0),
                    {{0, 1, 3}, {1, 2, 3}, {2, 3, 3}, {3, 4, 3}, {4, 5, 3}, {5, 6, 3}, {6, 7, 3}}};
  const auto halves = [](const BodyGraph& set, int most_bodies) {
    Partition parts{{}, 2};
    for (int body = 0; body < set.body_count(); ++body) parts.part_of_body.push_back(body / most_bodies);
    return parts;
  };
  const Partition nested = split_by_recursion(path.graph(), 2, 2, halves);
  EXPECT_EQ(nested.part_of_body, (std::vector<int>{0, 0, 1, 1, 2, 2, 3, 3}));
  EXPECT_EQ(nested.parent_of_part, (std::vector<int>{5, 5, 4, 4, 6, 6, -1}));
}

// By hand: what splits the first two of four bodies from the rest, and no set without both kinds.
TEST(Nested, takes_sets_that_are_left_whole_as_leaves) {
  const Bodies four{"loose", std::vector<double>(4, 1.0), {}, {0, 0, 0, 0, 0, 0, 9, 0, 0, 9, 0, 0}};
  const auto by_place = [](const BodyGraph& set, int) {
    Partition parts{{}, 1};
    for (int body = 0; body < set.body_count(); ++body)
      parts.part_of_body.push_back(set.position_m(body, 0) > set.position_m(0, 0));
    parts.part_count += parts.part_of_body.back();
    return parts;
  };
  const Partition nested = split_by_recursion(four.graph(), 1, 2, by_place);
  EXPECT_EQ(nested.part_of_body, (std::vector<int>{0, 0, 1, 1}));
  EXPECT_EQ(nested.parent_of_part, (std::vector<int>{2, 2, -1}));
  const auto whole = [](const BodyGraph& set, int) {
    return Partition{std::vector<int>(set.body_count(), 0), 1};
  };
  EXPECT_EQ(split_by_recursion(four.graph(), 1, 2, whole).parent_of_part, std::vector<int>{-1});
}

TEST(Nested, refuses_bounds_that_are_none) {
  const auto never = [](const BodyGraph&, int) { return Partition(); };
  EXPECT_THROW(split_by_recursion(BodyGraph(), 0, 2, never), std::invalid_argument);
  EXPECT_THROW(split_by_recursion(BodyGraph(), 1, 1, never), std::invalid_argument);
}

constexpr auto kPairName = [](const auto& info) {
  std::string name = std::get<0>(info.param).name + std::string("_") + std::get<1>(info.param).name;
  std::ranges::replace_if(
      name, [](unsigned char c) { return !std::isalnum(c); }, '_');
  return name;
};
INSTANTIATE_TEST_SUITE_P(All, NestedContract,
                         testing::Combine(testing::ValuesIn(rows_that_split_by_recursion()),
                                          testing::ValuesIn(refiners().begin(), refiners().end())),
                         kPairName);

}  // namespace
}  // namespace cleave::partition_test
