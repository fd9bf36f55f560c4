// Counted work against its slow twin, the model against sums by hand, and calibrations as text.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <numeric>
#include <set>
#include <stdexcept>

#include "partition/calibration.h"
#include "partition/cost_features.h"
#include "partition/cost_model.h"
#include "partition/cut_cover.h"
#include "partition/nested.h"
#include "partition/partition_cost.h"
#include "partition/registry.h"
#include "tests/partition/slow_cost.h"
#include "tests/partition/test_graphs.h"

namespace cleave::partition_test {
namespace {

constexpr std::uint64_t kSeeds = 150;
constexpr CostKernel kKernels[] = {CostKernel::schur_rows, CostKernel::schur_bodies, CostKernel::schur_nested,
                                   CostKernel::monolithic};

void expect_near(double expected, double actual, const char* what) {
  EXPECT_NEAR(expected, actual, 1e-9 * (1 + std::abs(expected))) << what;
}

void expect_equal(const CostFeatures& expected, const CostFeatures& actual) {
  EXPECT_EQ(expected.bodies, actual.bodies);
  EXPECT_EQ(expected.edges, actual.edges);
  EXPECT_EQ(expected.fixed_rows, actual.fixed_rows);
  EXPECT_NEAR(expected.mass_spread, actual.mass_spread, 1e-6);
  EXPECT_EQ(expected.rows, actual.rows);
  EXPECT_EQ(expected.cut_rows, actual.cut_rows);
  EXPECT_EQ(expected.cover_bodies, actual.cover_bodies);
  expect_near(expected.interface_unknowns, actual.interface_unknowns, "interface_unknowns");
  expect_near(expected.interface_flops, actual.interface_flops, "interface_flops");
  expect_near(expected.interface_entries, actual.interface_entries, "interface_entries");
  expect_near(expected.interface_blocks, actual.interface_blocks, "interface_blocks");
  ASSERT_EQ(expected.parts.size(), actual.parts.size());
  for (std::size_t k = 0; k < expected.parts.size(); ++k) {
    SCOPED_TRACE("part " + std::to_string(k));
    EXPECT_EQ(expected.parts[k].bodies, actual.parts[k].bodies);
    EXPECT_EQ(expected.parts[k].rows, actual.parts[k].rows);
    EXPECT_EQ(expected.parts[k].cut_rows, actual.parts[k].cut_rows);
    expect_near(expected.parts[k].factor_flops, actual.parts[k].factor_flops, "factor_flops");
    expect_near(expected.parts[k].form_flops, actual.parts[k].form_flops, "form_flops");
    expect_near(expected.parts[k].blocks, actual.parts[k].blocks, "blocks");
    expect_near(expected.parts[k].entries, actual.parts[k].entries, "entries");
  }
}

// Two or three nodes get a parent, again and again, until one is left. Empty of no part.
std::vector<int> random_tree(Random& random, int parts) {
  std::vector<int> parent_of_part(parts, -1), without_parent(parts);
  std::iota(without_parent.begin(), without_parent.end(), 0);
  while (without_parent.size() > 1) {
    const int node = static_cast<int>(parent_of_part.size());
    const int children = random.integer(2, std::min(3, static_cast<int>(without_parent.size())));
    for (int child = 0; child < children; ++child) {
      const int place = random.integer(0, static_cast<int>(without_parent.size()) - 1);
      parent_of_part[without_parent[place]] = node;
      without_parent.erase(without_parent.begin() + place);
    }
    parent_of_part.push_back(-1);
    without_parent.push_back(node);
  }
  return parent_of_part;
}

// In a tree, or now and then in one level.
Partition random_parts(Random& random, int bodies) {
  Partition partition = random_partition(random, bodies);
  if (random.chance(0.75)) partition.parent_of_part = random_tree(random, partition.part_count);
  return partition;
}

TEST(SeparatorNodes, are_those_of_the_slow_twin) {
  int inner = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Bodies bodies = random_bodies(seed);
    SCOPED_TRACE(describe(bodies) + ", seed " + std::to_string(seed));
    const BodyGraph graph = bodies.graph();
    Random random(seed);
    const Partition partition = random_parts(random, graph.body_count());
    const std::vector<int> nodes =
        separator_nodes(graph, partition.part_of_body, partition.part_count, partition.parent_of_part);
    EXPECT_EQ(nodes, slow_separator_nodes(graph, partition));
    for (const int node : nodes) inner += node > partition.part_count;
  }
  EXPECT_GT(inner, 100);
}

// Of one level the interface is that of schur-bodies.
TEST(CostFeatures, of_nested_parts_in_one_level_are_those_of_schur_bodies) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const BodyGraph graph = random_bodies(seed).graph();
    Random random(seed);
    const Partition partition = random_partition(random, graph.body_count());
    CostFeatures nested = CostCounter(graph, CostKernel::schur_nested, 1).count(partition);
    expect_equal(CostCounter(graph, CostKernel::schur_bodies, 1).count(partition), nested);
  }
}

TEST(CostFeatures, are_those_of_the_slow_twin) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Bodies bodies = random_bodies(seed);
    SCOPED_TRACE(describe(bodies) + ", seed " + std::to_string(seed));
    const BodyGraph graph = bodies.graph();
    Random random(seed);
    const Partition partition = random_parts(random, graph.body_count());
    const double share = random.real(0, 1);
    for (const CostKernel kernel : kKernels) {
      SCOPED_TRACE(cost_kernel_names()[static_cast<int>(kernel)]);
      expect_equal(slow_cost_features(graph, partition, kernel, share),
                   CostCounter(graph, kernel, share).count(partition));
    }
  }
}

// 0 - 1 - 2 in a row, and 3 that touches only the ground.
TEST(CostFeatures, by_hand) {
  const std::vector<ConstraintLink> links = {{0, 1, 3}, {1, 2, 3}, {0, -1, 3}, {3, -1, 6}};
  const BodyGraph graph(std::vector{1.0, 1.0, 1.0, 1.0}, links);
  const CostFeatures features = CostCounter(graph, CostKernel::schur_rows, 1).count({{0, 0, 1, 1}, 2});
  EXPECT_EQ(features.rows, 15);
  EXPECT_EQ(features.cut_rows, 3);
  EXPECT_EQ(features.parts[0].rows, 6);
  EXPECT_EQ(features.parts[1].rows, 6);
  const double one = 1 + 4 + 9 + 16 + 25 + 36,
               two = 49 + 64 + 81 + 100 + 121 + 144;  // columns of 6 and of 12
  EXPECT_EQ(features.parts[0].factor_flops, two + one);
  EXPECT_EQ(features.parts[1].factor_flops, one + one);
  EXPECT_EQ(features.parts[1].form_flops, 36 * 3 + 6 * 9);
  EXPECT_EQ(features.interface_flops, 1 + 4 + 9);
}

TEST(Elimination, of_a_path_fills_nothing) {
  std::vector<ConstraintLink> links;
  for (int k = 0; k + 1 < 50; ++k) links.push_back({k, k + 1, 1});
  const BodyGraph graph(std::vector<double>(50, 1.0), links);
  std::vector<int> bodies(50);
  std::iota(bodies.begin(), bodies.end(), 0);
  Eliminator eliminator(graph);
  int blocks = 0;
  for (const EliminatedColumn& column : eliminator.run(bodies)) blocks += column.below;
  EXPECT_EQ(blocks, 49);
}

TEST(CostModel, is_the_sum_of_its_terms) {
  Random random(7);
  const BodyGraph graph = pile(random, 5, 5, 3).graph();
  const Partition partition = random_partition(random, graph.body_count());
  const CostFeatures features = CostCounter(graph, CostKernel::schur_rows, 0.5).count(partition);
  KernelCost cost{CostKernel::schur_rows, 1, ExpectedFactorizations::always(3), {}, {}};
  std::iota(cost.cost.begin(), cost.cost.end(), 1.0);
  double local = 0, forming = 0, blocks = 0, entries = features.interface_entries;
  for (const PartCost& part : features.parts) {
    local += part.factor_flops;
    forming += part.form_flops;
    blocks += part.blocks;
    entries += part.entries;
  }
  const double once_ns = 1e3 * 1 + (2 + 3) * features.rows + 4 * blocks + 12 * features.bodies;
  const double pass_ns = 5e3 * features.parts.size() + 6 * features.rows + 7 * blocks + 8 * local +
                         9 * forming + 10 * features.interface_flops + 11 * entries;
  expect_near(1e-6 * (once_ns + 3 * pass_ns), modelled_ms(features, cost), "ms");
}

TEST(ExpectedFactorizations, follow_bodies_degree_and_masses_within_what_was_fitted) {
  CostFeatures features;
  features.bodies = 10, features.edges = 25, features.mass_spread = 2, features.fixed_rows = 40;
  const ExpectedFactorizations law{0.5, 0.25, -0.1, 0.125, 0.0625, 5};
  EXPECT_NEAR(law.of(features), std::exp(0.5 - 0.25 + 0.25 + 0.25) * std::pow(10, 0.25), 1e-12);
  features.mass_spread = 20;
  EXPECT_EQ(law.of(features), 5);
  features.edges = 1000;
  EXPECT_EQ(law.of(features), 1);
  EXPECT_EQ(law.of({}), std::exp(0.5));  // no bodies
  EXPECT_NEAR(ExpectedFactorizations::always(7).of(features), 7, 1e-12);
}

TEST(ExpectedActiveShare, follows_degree_and_contacts_within_zero_and_one) {
  const auto chain = [](int edges, int constraints) {
    std::vector<ConstraintLink> links = {{0, -1, 3}};
    for (int k = 0; k < edges * constraints; ++k) links.push_back({k % edges, k % edges + 1, 3});
    return BodyGraph(std::vector(8, 1.0), links);
  };
  const ExpectedActiveShare law{1.25, 2, 0.125};
  EXPECT_NEAR(law.of(chain(7, 2)), 1 - std::exp(-1.5) * std::pow(8.0 / 7, 2), 1e-12);
  EXPECT_EQ(law.of(chain(1, 1)), 0);  // exp(-1.375) 64 is more than 1
  EXPECT_NEAR(law.of(chain(0, 1)), 1 - std::exp(-1.25), 1e-12);
  EXPECT_NEAR(ExpectedActiveShare::always(0.7).of(chain(3, 1)), 0.7, 1e-12);
  EXPECT_EQ(ExpectedActiveShare::always(1).of(chain(3, 1)), 1);
}

// The graph of a seed, random parts, and a cost of other numbers in every term.
struct MovedParts {
  MovedParts(std::uint64_t seed, CostKernel kernel)
      : random(seed),
        graph(pile(random, 4, 4, 2).graph()),
        partition(random_partition(random, graph.body_count())),
        cost{kernel,
             random.integer(1, 2),
             ExpectedFactorizations::always(3),
             ExpectedActiveShare::always(0.4),
             {}} {
    std::iota(cost.cost.begin(), cost.cost.end(), 1.0);
  }

  double counted_ms() const {
    return modelled_ms(CostCounter(graph, cost.kernel, cost.active_share.of(graph)).count(partition), cost);
  }

  Random random;
  BodyGraph graph;
  Partition partition;
  KernelCost cost;
  int moves = 0;
};

// How many of 60 random moves leave a time that is not the one of all parts counted anew. disturb: a body
// that the partition alone has in another part from the start, -1 for none.
int wrong_times(MovedParts& parts, int disturb = -1) {
  PartitionCost time(parts.graph, parts.cost, parts.partition);
  std::vector<int>& part_of_body = parts.partition.part_of_body;
  if (disturb >= 0) part_of_body[disturb] = (part_of_body[disturb] + 1) % parts.partition.part_count;
  int wrong = 0;
  for (int k = 0; k < 60; ++k) {
    const int body = parts.random.integer(0, parts.graph.body_count() - 1);
    const int part = parts.random.integer(0, parts.partition.part_count - 1), own = part_of_body[body];
    if (part == own || body == disturb || part_sizes(parts.partition)[own] == 1) continue;
    const double before = time.ms();
    const bool moved = time.move_if_cheaper(body, part);
    if (moved) part_of_body[body] = part;
    parts.moves += moved;
    wrong += moved != (time.ms() < before) || time.ms() != parts.counted_ms();
  }
  return wrong;
}

TEST(PartitionCost, stays_what_it_is_from_scratch) {
  for (const CostKernel kernel : {CostKernel::schur_rows, CostKernel::schur_bodies}) {
    int moves = 0;
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
      MovedParts parts(seed, kernel);
      ASSERT_EQ(wrong_times(parts), 0) << "seed " << seed;
      moves += parts.moves;
    }
    EXPECT_GT(moves, 100);
  }
}

// Nothing is counted anew from a partition that was changed unseen: the check above has to tell it.
TEST(PartitionCost, the_check_sees_a_time_that_has_gone_wrong) {
  int seen = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    MovedParts parts(seed, CostKernel::schur_rows);
    const int own = parts.partition.part_of_body[0];
    if (parts.partition.part_count == 1 || part_sizes(parts.partition)[own] == 1) continue;
    seen += wrong_times(parts, 0) > 0;
  }
  EXPECT_GT(seen, 20);
}

TEST(CostModel, deals_the_longest_task_out_first) {
  EXPECT_EQ(longest_first_makespan({2, 3, 4, 6}, 2), 8);            // 6 + 2, 4 + 3
  EXPECT_EQ(longest_first_makespan({5, 5, 4, 4, 3, 3, 3}, 3), 11);  // not the best, which is 9
  EXPECT_EQ(longest_first_makespan({5, 1}, 8), 5);
  EXPECT_EQ(longest_first_makespan({}, 2), 0);
}

// The cheapest of the candidates of auto, each made and modelled by itself.
struct LeastChoice {
  std::string text;
  double ms;
};

LeastChoice least_choice(const BodyGraph& graph, const KernelCost& cost) {
  std::string best;
  double least_ms = 0;
  const auto look = [&](const std::string& partitioner, int max_bodies, const std::string& refiner) {
    Partition parts = make_partitioner(partitioner)->run(graph);
    make_refiner(refiner)->run(graph, max_bodies, parts);
    if (cost.kernel == CostKernel::schur_nested && partitioner != "single")
      parts = SetSplitter(read_partitioner(partitioner), read_refiner(refiner), 2).run(graph);
    const double ms =
        modelled_ms(CostCounter(graph, cost.kernel, cost.active_share.of(graph)).count(parts), cost) *
        (partitioner == "single" ? 1 : 1.05);  // splitting is to be worth it
    if (best.empty() || ms < least_ms) best = partitioner + "+" + refiner, least_ms = ms;
  };
  look("single", graph.body_count(), "none");
  for (const int max_bodies : {10, 25, 50, 100, 200})
    for (const std::string partitioner : {"mindp", "mix", "multilevel"})
      for (const char* refiner : {"none", "fm"})
        if (max_bodies < graph.body_count() && cost.kernel != CostKernel::monolithic)
          look(partitioner + "@max-bodies=" + std::to_string(max_bodies), max_bodies, refiner);
  return {best + "/" + cost_kernel_names()[static_cast<int>(cost.kernel)], least_ms};
}

// The cheapest of the runs of a partitioner with these seeds, the earliest of equal ones.
struct Cheapest {
  std::vector<int> part_of_body;
  int seed;
};

Cheapest cheapest_of(const std::string& name, const std::vector<int>& seeds, const BodyGraph& graph,
                     const KernelCost& cost) {
  Cheapest cheapest;
  double least_ms = std::numeric_limits<double>::infinity();
  for (const int seed : seeds) {
    const Partition parts = make_partitioner(name + "@partition-seed=" + std::to_string(seed))->run(graph);
    const double share = cost.active_share.of(graph);
    const double ms = modelled_ms(slow_cost_features(graph, parts, cost.kernel, share), cost);
    if (ms < least_ms) cheapest = {parts.part_of_body, seed}, least_ms = ms;
  }
  return cheapest;
}

TEST(CheapestTrial, is_the_least_by_the_model) {
  const Calibration& shipped = known_calibration(read_calibration("calibration", "shipped"));
  std::set<int> seeds;
  for (const CostKernel kernel :
       {CostKernel::schur_rows, CostKernel::schur_bodies, CostKernel::schur_nested}) {
    const std::string by = "@partition-seed=7@max-bodies=10@cost-kernel=" +
                           std::string(cost_kernel_names()[static_cast<int>(kernel)]);
    for (const int height : {1, 3, 5}) {
      Random random(height);
      const BodyGraph graph = pile(random, 4, 4, height).graph();
      const auto expected = [&](const std::string& name) {
        const Cheapest cheapest = cheapest_of(name, {7, 8, 9, 10, 11, 12}, graph, shipped.of(kernel, 1));
        seeds.insert(cheapest.seed);
        return cheapest.part_of_body;
      };
      for (const std::string more : {"@karger-method=contract", "@karger-method=recursive-bisection"})
        EXPECT_EQ(make_partitioner("karger-cost@trials=6" + more + by)->run(graph).part_of_body,
                  expected("karger@trials=1@max-bodies=10" + more));
      for (const std::string more : {"@effort=fast", "@effort=best"})
        EXPECT_EQ(make_partitioner("multilevel-cost@seeds=6" + more + by)->run(graph).part_of_body,
                  expected("multilevel@max-bodies=10" + more));
    }
  }
  EXPECT_GT(seeds.size(), 3u) << "the first is the cheapest too often to tell";
}

// On a ring of equal bodies every cut costs the same, but few are the same.
TEST(CheapestTrial, is_the_earliest_of_equal_ones) {
  Bodies ring{.family = "ring", .mass_kg = std::vector<double>(16, 1.0), .links = {}};
  for (int body = 0; body < 16; ++body) ring.links.push_back({body, (body + 1) % 16, 3});
  const BodyGraph graph = ring.graph();
  const std::string bound = "@max-bodies=8@max-growth=0";
  std::set<std::vector<int>> found;
  for (int seed = 1; seed <= 9; ++seed)
    found.insert(make_partitioner("multilevel@partition-seed=" + std::to_string(seed) + bound)
                     ->run(graph)
                     .part_of_body);
  ASSERT_GT(found.size(), 1u);
  EXPECT_EQ(make_partitioner("multilevel-cost@seeds=9" + bound)->run(graph).part_of_body,
            make_partitioner("multilevel" + bound)->run(graph).part_of_body);
}

// Where nothing can be told apart the first trial stands.
TEST(CheapestTrial, is_one_where_all_times_are_infinite) {
  KernelCost cost{CostKernel::schur_rows, 1, {}, {}, {}};
  std::ranges::fill(cost.cost, std::numeric_limits<double>::max());
  const std::string path = testing::TempDir() + "dear_test.toml";
  std::ofstream(path, std::ios::binary) << calibration_text({}, {cost});
  const std::string fingerprint = read_calibration("--calibration", path);
  std::remove(path.c_str());
  Random random(1);
  const BodyGraph graph = pile(random, 12, 12, 4).graph();
  const Partition first = make_partitioner("multilevel")->run(graph);
  ASSERT_TRUE(std::isinf(modelled_ms(cost_counter(graph, cost).count(first), cost)));
  EXPECT_EQ(make_partitioner("multilevel-cost@seeds=3@calibration=" + fingerprint)->run(graph).part_of_body,
            first.part_of_body);
}

TEST(CheapestTrial, goes_on_from_the_last_seed_with_the_first) {
  Random random(1);
  const BodyGraph graph = pile(random, 4, 4, 3).graph();
  const std::string last = "karger-cost@trials=3@max-bodies=10@partition-seed=2147483647";
  const Calibration& shipped = known_calibration(read_calibration("calibration", "shipped"));
  const Cheapest cheapest = cheapest_of("karger@trials=1@max-bodies=10", {2147483647, 0, 1}, graph,
                                        shipped.of(CostKernel::schur_rows, 1));
  EXPECT_EQ(make_partitioner(last)->run(graph).part_of_body, cheapest.part_of_body);
}

TEST(Auto, takes_what_is_cheapest_by_the_model) {
  const Calibration& shipped = known_calibration(read_calibration("calibration", "shipped"));
  for (const CostKernel kernel :
       {CostKernel::schur_rows, CostKernel::schur_bodies, CostKernel::schur_nested}) {
    for (const int threads : {1, 2}) {
      for (const int height : {1, 3, 9}) {
        Random random(3);
        const BodyGraph graph = pile(random, 5, 5, height).graph();
        const Partition parts = make_partitioner("auto@cost-kernel=" +
                                                 std::string(cost_kernel_names()[static_cast<int>(kernel)]) +
                                                 "@cost-threads=" + std::to_string(threads))
                                    ->run(graph);
        EXPECT_EQ(parts.choice, least_choice(graph, shipped.of(kernel, threads)).text);
      }
    }
  }
}

TEST(Auto, takes_the_cheapest_kernel_where_any_may_be) {
  const Calibration& shipped = known_calibration(read_calibration("calibration", "shipped"));
  for (const int threads : {1, 2}) {
    for (const int height : {1, 3, 9}) {
      Random random(3);
      const BodyGraph graph = pile(random, 5, 5, height).graph();
      std::vector<LeastChoice> of_kernels;
      for (const CostKernel kernel : kKernels)
        of_kernels.push_back(least_choice(graph, shipped.of(kernel, threads)));
      const auto chosen = make_partitioner("auto@cost-kernel=any@cost-threads=" + std::to_string(threads));
      EXPECT_EQ(chosen->run(graph).choice, std::ranges::min(of_kernels, {}, &LeastChoice::ms).text);
    }
  }
}

// Costs by which every kernel is cheapest in turn.
TEST(Auto, chooses_every_kernel_where_it_is_cheapest) {
  Random random(3);
  const BodyGraph graph = pile(random, 5, 5, 3).graph();
  for (std::size_t cheapest = 0; cheapest < cost_kernel_names().size(); ++cheapest) {
    std::vector<KernelCost> costs;
    for (std::size_t k = 0; k < cost_kernel_names().size(); ++k) {
      costs.push_back({static_cast<CostKernel>(k), 1, ExpectedFactorizations::always(1), {}, {}});
      costs.back().cost[0] = k == cheapest ? 1 : 2;
    }
    const std::string path = testing::TempDir() + "any_test.toml";
    std::ofstream(path, std::ios::binary) << calibration_text({}, costs);
    const std::string fingerprint = read_calibration("--calibration", path);
    std::remove(path.c_str());
    const auto chosen = make_partitioner("auto@cost-kernel=any@calibration=" + fingerprint);
    EXPECT_EQ(chosen->run(graph).choice, std::string("single+none/") + cost_kernel_names()[cheapest]);
  }
}

TEST(Auto, alone_chooses_among_kernels) {
  try {
    make_refiner("fm-cost@cost-kernel=any");
    FAIL() << "was made";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "--cost-kernel is any, allowed: one kernel; only auto chooses among all");
  }
}

// auto where one term of the model costs and nothing else does.
std::unique_ptr<Partitioner> auto_by_term(int term) {
  KernelCost cost{CostKernel::schur_rows, 1, {}, {}, {}};
  cost.cost[term] = 1;
  const std::string path = testing::TempDir() + "auto_test.toml";
  std::ofstream(path, std::ios::binary) << calibration_text({}, {cost});
  const std::string fingerprint = read_calibration("--calibration", path);
  std::remove(path.c_str());
  return make_partitioner("auto@calibration=" + fingerprint);
}

// A calibration in which only factoring the parts costs anything makes them small, one in which only parts
// cost, one.
TEST(Auto, follows_the_calibration) {
  Random random(3);
  const BodyGraph graph = pile(random, 6, 6, 4).graph();
  const auto choice_of = [&](int term) { return auto_by_term(term)->run(graph).choice; };
  EXPECT_EQ(choice_of(4), "single+none/schur-rows");
  EXPECT_NE(choice_of(7).find("max-bodies=10"), std::string::npos) << choice_of(7);
}

TEST(Auto, chooses_again_where_the_graph_is_of_another_size) {
  Random random(3);
  const BodyGraph small = pile(random, 2, 2, 2).graph(), large = pile(random, 6, 6, 12).graph();
  const BodyGraph alike = pile(random, 6, 6, 11).graph();
  ASSERT_LT(large.edge_count(), 1.25 * alike.edge_count());
  const BodyGraph empty(std::vector(5, 1.0), {});
  const std::unique_ptr<Partitioner> once = auto_by_term(7);
  const std::string nothing = "single+none/schur-rows";
  EXPECT_EQ(once->run(empty).choice, nothing);
  const std::string of_large = once->run(large).choice;
  ASSERT_NE(of_large, nothing);
  EXPECT_EQ(once->run(alike).choice, of_large);
  EXPECT_EQ(once->run(empty).choice, of_large);  // nothing to choose by
  EXPECT_EQ(once->run(small).choice, nothing);   // too few bodies to split
  EXPECT_EQ(once->run(alike).choice, auto_by_term(7)->run(alike).choice);
}

TEST(Auto, keeps_a_choice_that_was_made_before) {
  Random random(3);
  const BodyGraph graph = pile(random, 6, 6, 12).graph();
  const std::string other = "mix@max-bodies=100+fm/schur-rows";
  ASSERT_NE(make_partitioner("auto")->run(graph).choice, other);
  const std::unique_ptr<Partitioner> fixed = make_partitioner("auto");
  fixed->keep_choice(other);
  EXPECT_EQ(fixed->run(graph).choice, other);
  EXPECT_THROW(fixed->keep_choice("mix@max-bodies=99+fm/schur-rows"), std::invalid_argument);
  EXPECT_THROW(fixed->keep_choice("mix@max-bodies=100+fm/schur-bodies"), std::invalid_argument);
  const std::unique_ptr<Partitioner> any = make_partitioner("auto@cost-kernel=any");
  for (const char* choice : {"mix@max-bodies=100+fm/schur-bodies", "mix@max-bodies=10+fm/schur-nested",
                             "single+none/monolithic"}) {
    any->keep_choice(choice);
    EXPECT_EQ(any->run(graph).choice, choice);
  }
  EXPECT_THROW(any->keep_choice("mix@max-bodies=100+fm/monolithic"), std::invalid_argument);
  EXPECT_THROW(any->keep_choice("single+none/any"), std::invalid_argument);
  EXPECT_THROW(make_partitioner("mix")->keep_choice(other), std::invalid_argument);
}

std::vector<KernelCost> some_costs() {
  KernelCost one{CostKernel::schur_rows, 1, {-0.5, 0.25, -0.125, 0.0625, 0.03125, 6}, {0.25, 1.5, 0.75}, {}};
  std::iota(one.cost.begin(), one.cost.end(), 0.5);
  KernelCost two = one;
  two.threads = 2;
  two.cost[0] = 1e-7;
  return {one, two};
}

TEST(Calibration, reads_what_it_writes) {
  const std::string text = calibration_text({{"cpu", "some [processor] = fast"}}, some_costs());
  const Calibration read = parse_calibration("text", text);
  ASSERT_EQ(read.kernels.size(), 2u);
  for (int k : {0, 1}) {
    EXPECT_EQ(read.kernels[k].threads, k + 1);
    EXPECT_EQ(read.kernels[k].factorizations.constant, -0.5);
    EXPECT_EQ(read.kernels[k].factorizations.per_log_body, 0.25);
    EXPECT_EQ(read.kernels[k].factorizations.per_degree, -0.125);
    EXPECT_EQ(read.kernels[k].factorizations.per_mass_spread, 0.0625);
    EXPECT_EQ(read.kernels[k].factorizations.per_fixed_row, 0.03125);
    EXPECT_EQ(read.kernels[k].factorizations.most, 6);
    EXPECT_EQ(read.kernels[k].active_share.constant, 0.25);
    EXPECT_EQ(read.kernels[k].active_share.per_log_degree, 1.5);
    EXPECT_EQ(read.kernels[k].active_share.per_constraint, 0.75);
    EXPECT_EQ(read.kernels[k].cost, some_costs()[k].cost);
  }
  EXPECT_EQ(read.fingerprint, parse_calibration("text", text).fingerprint);
  EXPECT_NE(read.fingerprint, parse_calibration("text", "# seen\n" + text).fingerprint);
}

TEST(Calibration, takes_the_most_threads_that_were_calibrated) {
  const Calibration read = parse_calibration("text", calibration_text({}, some_costs()));
  EXPECT_EQ(read.of(CostKernel::schur_rows, 1).cost[0], 0.5);
  EXPECT_EQ(read.of(CostKernel::schur_rows, 8).cost[0], 1e-7);
  EXPECT_EQ(read.of(CostKernel::schur_rows, 8).threads, 8);
  EXPECT_THROW(read.of(CostKernel::monolithic, 1), std::invalid_argument);
}

std::string error_of(const std::string& text) {
  try {
    parse_calibration("text", text);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  return text.replace(text.find(what), what.size(), by);
}

TEST(Calibration, names_the_line_that_is_wrong) {
  const std::string good = calibration_text({}, some_costs());
  EXPECT_EQ(error_of(good), "");
  EXPECT_EQ(error_of(""), "text is no calibration: schema = \"cleave-calibration-4\" is missing");
  EXPECT_EQ(error_of(replaced(good, "schur-rows", "schur-row")),
            "text: line 3: 'schur-row' is unknown (did you mean 'schur-rows'?); choices: schur-rows, "
            "schur-bodies, schur-nested, monolithic");
  EXPECT_EQ(error_of(replaced(good, "factorizations_most = 6", "factorizations_most = 0")),
            "text: line 9: factorizations_most: 0 is not in [1, inf)");
  EXPECT_EQ(error_of(replaced(good, "active_share_constant = 0.25\n", "")),
            "text lacks active_share_constant of [schur-rows.threads-1]");
  EXPECT_EQ(error_of(replaced(good, "threads-2", "threads-1")),
            "text: line 26: [schur-rows.threads-1] stands twice");
  EXPECT_EQ(error_of(replaced(good, "us_per_solve = 0.5", "us_per_solve = -1")),
            "text: line 13: us_per_solve: -1 is not in [0, inf)");
  EXPECT_EQ(error_of(replaced(good, "us_per_solve", "us_per_solves")).substr(0, 44),
            "text: line 13: 'us_per_solves' is unknown (d");
}

TEST(Calibration, is_known_once_it_was_read) {
  const std::string shipped = read_calibration("--calibration", "shipped");
  EXPECT_EQ(known_calibration(shipped).fingerprint, shipped);
  for (const CostKernel kernel : kKernels)
    for (const int threads : {1, 2})
      EXPECT_EQ(known_calibration(shipped).of(kernel, threads).threads, threads);
  EXPECT_THROW(known_calibration("0123456789abcdef"), std::invalid_argument);
  EXPECT_THROW(read_calibration("--calibration", "no such file"), std::invalid_argument);
  const std::string path = testing::TempDir() + "calibration_test.toml";
  std::ofstream(path, std::ios::binary) << calibration_text({}, some_costs());
  const std::string read = read_calibration("--calibration", path);
  std::remove(path.c_str());
  EXPECT_EQ(known_calibration(read).kernels.size(), 2u);
}

}  // namespace
}  // namespace cleave::partition_test
