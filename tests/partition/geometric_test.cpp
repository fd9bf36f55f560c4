// geometric against its definition, and on bodies whose parts are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "partition/registry.h"
#include "tests/partition/brute_force.h"
#include "tests/partition/test_graphs.h"

namespace cleave::partition_test {
namespace {

Partition split(const Bodies& bodies, int max_bodies) {
  return make_partitioner("geometric@max-bodies=" + std::to_string(max_bodies))->run(bodies.graph());
}

// The definition of the head comment: sets are sorted as a whole and cut in two. Gives the set of each body a
// name.
void bisect(const std::vector<double>& position_m, std::vector<int> bodies, int parts,
            const std::string& name, std::vector<std::string>& name_of_body) {
  if (parts == 1) {
    for (const int body : bodies) name_of_body[body] = name;
    return;
  }
  const auto at = [&](int body, int axis) { return position_m.at(3 * body + axis); };
  std::array<double, 3> extent_m{};
  for (int axis = 0; axis < 3; ++axis)
    for (const int a : bodies)
      for (const int b : bodies) extent_m[axis] = std::max(extent_m[axis], at(a, axis) - at(b, axis));
  int longest = 0;
  for (int axis = 1; axis < 3; ++axis)
    if (extent_m[axis] > extent_m[longest]) longest = axis;
  std::sort(bodies.begin(), bodies.end(),
            [&](int a, int b) { return std::tuple(at(a, longest), a) < std::tuple(at(b, longest), b); });
  const int lower_parts = parts / 2;
  const auto middle = bodies.begin() + static_cast<int>(bodies.size()) * lower_parts / parts;
  bisect(position_m, {bodies.begin(), middle}, lower_parts, name + "0", name_of_body);
  bisect(position_m, {middle, bodies.end()}, parts - lower_parts, name + "1", name_of_body);
}

Partition by_definition(const Bodies& bodies, int max_bodies) {
  std::vector<int> all(bodies.count());
  std::iota(all.begin(), all.end(), 0);
  std::vector<std::string> name_of_body(bodies.count());
  if (!all.empty()) {
    const int parts = static_cast<int>(std::ceil(bodies.count() / static_cast<double>(max_bodies)));
    bisect(bodies.positions(), all, parts, "", name_of_body);
  }
  Partition partition;
  std::map<std::string, int> part_of_name;
  for (const std::string& name : name_of_body) {
    const auto [entry, is_new] = part_of_name.emplace(name, partition.part_count);
    partition.part_count += is_new;
    partition.part_of_body.push_back(entry->second);
  }
  return partition;
}

TEST(Geometric, is_as_defined) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    const Bodies bodies = random_bodies(seed);
    Random random(seed + 4000);
    const int max_bodies = random.integer(1, 12);
    ASSERT_EQ(first_difference(by_definition(bodies, max_bodies), split(bodies, max_bodies)), "")
        << "seed " << seed << " (" << describe(bodies) << "), " << max_bodies << " a part";
  }
}

TEST(Geometric, makes_as_few_and_as_equal_parts_as_can_be) {
  for (int count = 1; count < 90; ++count) {
    const Bodies row{"row", std::vector<double>(count, 1.0), {}};
    for (int max_bodies = 1; max_bodies < 20; ++max_bodies) {
      const std::vector<int> sizes = part_sizes(split(row, max_bodies));
      ASSERT_EQ(static_cast<int>(sizes.size()), (count + max_bodies - 1) / max_bodies);
      const auto [least, most] = std::ranges::minmax(sizes);
      ASSERT_LE(most - least, 1) << count << " bodies, " << max_bodies << " a part";
    }
  }
}

// A path whose bodies stand in a row in another order than that of their indices.
TEST(Geometric, cuts_a_path_into_runs) {
  Random random(3);
  constexpr int kBodies = 40;
  for (const int axis : {0, 1, 2}) {
    const std::vector<int> body_at = random.permutation(kBodies);
    Bodies path{"path", std::vector<double>(kBodies, 1.0), {}, std::vector<double>(3 * kBodies, 0.5)};
    for (int place = 0; place < kBodies; ++place) {
      path.position_m[3 * body_at[place] + axis] = -0.25 * place;
      if (place > 0) path.links.push_back({body_at[place - 1], body_at[place], 3});
    }
    const PartitionMetrics metrics = metrics_by_counting(path, split(path, 10).part_of_body);
    EXPECT_EQ(metrics.parts, 4);
    EXPECT_EQ(metrics.cut_pairs, 3);
    EXPECT_EQ(metrics.max_part_bodies, 10);
    EXPECT_TRUE(metrics.contiguous);
  }
}

// Eight by eight bodies in four parts: the quadrants, whichever way the index runs.
TEST(Geometric, cuts_a_grid_into_blocks) {
  Random random(4);
  const std::vector<int> body_at = random.permutation(64);
  Bodies grid{"grid", std::vector<double>(64, 1.0), {}, std::vector<double>(3 * 64, 0.0)};
  for (int cell = 0; cell < 64; ++cell) {
    grid.position_m[3 * body_at[cell]] = cell % 8;
    grid.position_m[3 * body_at[cell] + 1] = cell / 8;
  }
  const Partition partition = split(grid, 16);
  std::set<int> parts;
  for (int cell = 0; cell < 64; ++cell) {
    const int corner = cell / 32 * 32 + cell % 8 / 4 * 4;  // of its quadrant
    EXPECT_EQ(partition.part_of_body[body_at[cell]], partition.part_of_body[body_at[corner]]) << cell;
    parts.insert(partition.part_of_body[body_at[cell]]);
  }
  EXPECT_EQ(parts.size(), 4u);
}

// Two balls of twenty bodies that all touch, with ten bodies in a row between them.
TEST(Geometric, cuts_a_dumb_bell_in_its_bar) {
  Random random(5);
  Bodies bell{"dumb-bell", std::vector<double>(50, 1.0), {}};
  const auto in_ball = [](int body) { return body < 20 || body >= 30; };
  for (int body = 0; body < 50; ++body) {
    const double x = body < 20 ? 0 : body < 30 ? body - 18 : 13;
    const double spread = in_ball(body) ? 1 : 0;
    for (const double centre : {x, 0.0, 0.0}) bell.position_m.push_back(centre + spread * random.real(-1, 1));
    for (int other = 0; in_ball(body) && other < body; ++other)
      if (in_ball(other) && (other < 20) == (body < 20)) bell.links.push_back({other, body, 3});
    if (!in_ball(body) || body == 30) bell.links.push_back({body - 1, body, 3});
  }
  const Partition partition = split(bell, 25);
  const PartitionMetrics metrics = metrics_by_counting(bell, partition.part_of_body);
  EXPECT_EQ(metrics.parts, 2);
  EXPECT_EQ(metrics.cut_pairs, 1);
  EXPECT_NE(partition.part_of_body[24], partition.part_of_body[25]);
}

TEST(Geometric, cuts_bodies_in_one_place_by_their_index) {
  const Bodies heap{"heap", std::vector<double>(10, 1.0), {}, std::vector<double>(30, 7.25)};
  EXPECT_EQ(split(heap, 4).part_of_body, (std::vector<int>{0, 0, 0, 1, 1, 1, 2, 2, 2, 2}));
}

TEST(Geometric, refuses_bodies_that_are_nowhere) {
  const auto partitioner = make_partitioner("geometric@max-bodies=4");
  try {
    partitioner->run(BodyGraph(std::vector<double>(5, 1.0), {}));
    ADD_FAILURE() << "five bodies without positions were split";
  } catch (const CannotSplit& error) {
    EXPECT_EQ(std::string(error.what()),
              "geometric: the positions of the bodies are not known, which it splits by");
  }
  EXPECT_EQ(partitioner->run(BodyGraph(std::vector<double>(4, 1.0), {})).part_count, 1);  // nothing to split
}

}  // namespace
}  // namespace cleave::partition_test
