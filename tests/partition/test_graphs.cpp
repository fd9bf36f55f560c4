#include "tests/partition/test_graphs.h"

#include <algorithm>
#include <numeric>
#include <sstream>

namespace cleave::partition_test {
namespace {

constexpr int kStatic = -1;

// A few joints or contact points between two bodies, in either order.
void connect(Random& random, Bodies& bodies, int a, int b) {
  const int constraints = random.integer(1, 4);
  for (int k = 0; k < constraints; ++k) {
    const int rows = random.pick(std::vector<int>{1, 3, 3, 3, 5, 6});
    bodies.links.push_back(random.chance(0.5) ? ConstraintLink{a, b, rows} : ConstraintLink{b, a, rows});
  }
}

void connect_at_random(Random& random, Bodies& bodies, int first, int last, double probability) {
  for (int a = first; a < last; ++a) {
    for (int b = a + 1; b < last; ++b) {
      if (random.chance(probability)) connect(random, bodies, a, b);
    }
  }
}

Bodies with_masses(Random& random, std::string family, int count) {
  Bodies bodies{std::move(family), std::vector<double>(count, 100), {}};
  const int kind = random.integer(0, 2);
  for (double& mass_kg : bodies.mass_kg) {
    if (kind == 1) mass_kg = random.pick(std::vector<double>{10, 100, 1000});
    if (kind == 2) mass_kg = random.real(0.1, 50);
  }
  return bodies;
}

Bodies path(Random& random) {
  Bodies bodies = with_masses(random, "path", random.integer(2, 80));
  for (int i = 1; i < bodies.count(); ++i) bodies.links.push_back({i - 1, i, 3});
  return bodies;
}

Bodies star(Random& random) {
  Bodies bodies = with_masses(random, "star", random.integer(3, 60));
  for (int i = 1; i < bodies.count(); ++i) connect(random, bodies, 0, i);
  return bodies;
}

Bodies tree(Random& random) {
  Bodies bodies = with_masses(random, "tree", random.integer(2, 70));
  for (int i = 1; i < bodies.count(); ++i) connect(random, bodies, random.integer(0, i - 1), i);
  return bodies;
}

Bodies complete(Random& random) {
  Bodies bodies = with_masses(random, "complete", random.integer(2, 22));
  connect_at_random(random, bodies, 0, bodies.count(), 1.1);
  return bodies;
}

Bodies uniform_random(Random& random, double neighbours) {
  Bodies bodies = with_masses(random, neighbours > 5 ? "dense" : "sparse", random.integer(2, 90));
  connect_at_random(random, bodies, 0, bodies.count(), neighbours / bodies.count());
  return bodies;
}

Bodies disconnected(Random& random) {
  Bodies bodies = with_masses(random, "disconnected", random.integer(4, 80));
  for (int first = 0; first < bodies.count();) {
    const int last = std::min(bodies.count(), first + random.integer(1, 20));
    connect_at_random(random, bodies, first, last, 0.4);
    first = last;
  }
  return bodies;
}

Bodies mostly_isolated(Random& random) {
  Bodies bodies = with_masses(random, "mostly isolated", random.integer(1, 40));
  connect_at_random(random, bodies, 0, bodies.count(), 0.02);
  return bodies;
}

Bodies of_family(Random& random, int family) {
  switch (family) {
    case 0: {
      Bodies bodies = with_masses(random, "few", random.integer(0, 4));
      connect_at_random(random, bodies, 0, bodies.count(), 0.6);
      return bodies;
    }
    case 1:
      return path(random);
    case 2:
      return star(random);
    case 3:
      return tree(random);
    case 4:
      return complete(random);
    case 5:
      return pile(random, random.integer(2, 5), random.integer(1, 4), random.integer(1, 5));
    case 6:
      return uniform_random(random, 3);
    case 7:
      return uniform_random(random, 9);
    case 8:
      return disconnected(random);
    default:
      return mostly_isolated(random);
  }
}

Bodies shuffled(Random& random, Bodies bodies) {
  const std::vector<int> new_index = random.permutation(bodies.count());
  const std::vector<double> old_mass_kg = bodies.mass_kg;
  for (int i = 0; i < bodies.count(); ++i) bodies.mass_kg[new_index[i]] = old_mass_kg[i];
  for (ConstraintLink& link : bodies.links)
    link = {new_index[link.body_a], new_index[link.body_b], link.rows};
  return bodies;
}

void add_links_that_are_no_edge(Random& random, Bodies& bodies) {
  for (int body = 0; body < bodies.count(); ++body) {
    if (random.chance(0.3)) bodies.links.push_back({body, kStatic, 3});
    if (random.chance(0.1)) bodies.links.push_back({kStatic, body, 3});
    if (random.chance(0.05)) bodies.links.push_back({body, body, 6});
  }
}

// With dice of their own, so that the graph of a seed stays what it was.
void place(Random random, Bodies& bodies) {
  const bool on_grid = random.chance(0.5);
  const double size_m[3] = {random.real(0, 5), random.real(0, 5), random.real(0, 5)};
  for (int k = 0; k < 3 * bodies.count(); ++k)
    bodies.position_m.push_back(on_grid ? random.integer(-1, 2) : random.real(0, size_m[k % 3]));
}

const char* name_of(EdgeWeight unit) {
  return unit == EdgeWeight::pairs ? "pairs" : unit == EdgeWeight::constraints ? "constraints" : "rows";
}

}  // namespace

std::vector<double> Bodies::positions() const {
  if (!position_m.empty()) return position_m;
  std::vector<double> row;
  for (int body = 0; body < count(); ++body) row.insert(row.end(), {static_cast<double>(body), 0.0, 0.0});
  return row;
}

std::vector<int> Bodies::groups() const {
  if (!group.empty()) return group;
  std::vector<int> in_turn;
  for (int body = 0; body < count(); ++body) in_turn.push_back(body % 4 - 1);
  return in_turn;
}

BodyGraph Bodies::graph() const {
  BodyGraph graph(mass_kg, links, std::nullopt, positions());
  graph.set_groups(groups());
  return graph;
}

std::vector<int> Random::permutation(int count) {
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  for (int i = count - 1; i > 0; --i) std::swap(order[i], order[integer(0, i)]);
  return order;
}

Bodies pile(Random& random, int width, int depth, int height) {
  Bodies bodies = with_masses(random, "pile", width * depth * height);
  const auto index = [&](int x, int y, int z) { return (z * depth + y) * width + x; };
  for (int z = 0; z < height; ++z) {
    for (int y = 0; y < depth; ++y) {
      for (int x = 0; x < width; ++x) {
        if (x > 0 && random.chance(0.6)) connect(random, bodies, index(x, y, z), index(x - 1, y, z));
        if (y > 0 && random.chance(0.6)) connect(random, bodies, index(x, y, z), index(x, y - 1, z));
        if (z > 0) connect(random, bodies, index(x, y, z), index(x, y, z - 1));
        if (z > 0 && x > 0 && random.chance(0.3))
          connect(random, bodies, index(x, y, z), index(x - 1, y, z - 1));
      }
    }
  }
  return bodies;
}

int bodies_in(const Partition& partition, int part) {
  return static_cast<int>(std::ranges::count(partition.part_of_body, part));
}

long rows_into(const Bodies& bodies, const Partition& partition, int body, int part) {
  long rows = 0;
  for (const ConstraintLink& link : bodies.links) {
    if (link.body_a < 0 || link.body_b < 0 || link.body_a == link.body_b) continue;
    if (link.body_a == body && partition.part_of_body[link.body_b] == part) rows += link.rows;
    if (link.body_b == body && partition.part_of_body[link.body_a] == part) rows += link.rows;
  }
  return rows;
}

Bodies random_bodies(std::uint64_t seed) {
  constexpr int kFamilies = 10;
  Random random(seed);
  Bodies bodies = of_family(random, static_cast<int>(seed % kFamilies));
  if (random.chance(0.5)) bodies = shuffled(random, bodies);
  add_links_that_are_no_edge(random, bodies);
  place(Random(seed + 9000), bodies);
  return bodies;
}

PartitionOptions random_partition_options(Random& random) {
  PartitionOptions options;
  options.max_bodies = random.chance(0.1) ? 1 : random.integer(2, 30);
  options.tau_mr = random.pick(std::vector<double>{1.5, 10, 10, 10.5, 100.5});
  options.tau_mix = random.pick(std::vector<double>{0, 0.1, 0.25, 0.3, 0.5, 0.5, 0.7, 0.9, 1});
  options.edge_weight =
      random.pick(std::vector<EdgeWeight>{EdgeWeight::pairs, EdgeWeight::constraints, EdgeWeight::rows});
  options.degree = random.chance(0.5) ? DegreeUnit::bodies : DegreeUnit::constraints;
  options.degree_scope = random.chance(0.5) ? DegreeScope::whole : DegreeScope::left;
  options.as_printed = random.chance(0.25);
  return options;
}

RefineOptions random_refine_options(Random& random) {
  RefineOptions options;
  options.max_bodies = random.chance(0.1) ? 1 : random.integer(2, 30);
  options.max_growth = random.pick(std::vector<double>{0, 0.1, 0.2, 0.2, 0.3, 0.5, 1});
  options.edge_weight =
      random.pick(std::vector<EdgeWeight>{EdgeWeight::pairs, EdgeWeight::constraints, EdgeWeight::rows});
  options.as_printed = random.chance(0.25);
  return options;
}

Partition random_partition(Random& random, int bodies) {
  Partition partition{std::vector<int>(bodies, 0), bodies == 0 ? 0 : random.integer(1, std::min(bodies, 12))};
  const std::vector<int> order = random.permutation(bodies);
  for (int k = 0; k < bodies; ++k) {
    const bool founds_a_part = k < partition.part_count;
    partition.part_of_body[order[k]] = founds_a_part ? k : random.integer(0, partition.part_count - 1);
  }
  return partition;
}

Bodies reversed(const Bodies& bodies) {
  Bodies result = bodies;
  result.position_m = bodies.positions();
  result.group = bodies.groups();
  std::ranges::reverse(result.group);
  const auto mirror = [&](int body) { return body == kStatic ? kStatic : bodies.count() - 1 - body; };
  std::ranges::reverse(result.mass_kg);
  const std::vector<double> position_m = bodies.positions();
  for (int body = 0; body < bodies.count(); ++body)
    std::copy_n(position_m.begin() + 3 * mirror(body), 3, result.position_m.begin() + 3 * body);
  for (ConstraintLink& link : result.links) link = {mirror(link.body_a), mirror(link.body_b), link.rows};
  return result;
}

Partition reversed(const Partition& partition) {
  Partition result = partition;
  std::ranges::reverse(result.part_of_body);
  return result;
}

std::string describe(const Bodies& bodies) {
  std::ostringstream text;
  text << bodies.family << ", " << bodies.count() << " bodies, " << bodies.links.size() << " links";
  return text.str();
}

std::string describe(const PartitionOptions& options) {
  std::ostringstream text;
  text << "max_bodies " << options.max_bodies << ", tau_mr " << options.tau_mr << ", tau_mix "
       << options.tau_mix << ", edge_weight " << name_of(options.edge_weight) << ", degree "
       << (options.degree == DegreeUnit::bodies ? "bodies" : "constraints") << ", degree_scope "
       << (options.degree_scope == DegreeScope::whole ? "whole" : "left") << ", as_printed "
       << options.as_printed;
  return text.str();
}

std::string describe(const RefineOptions& options) {
  std::ostringstream text;
  text << "max_bodies " << options.max_bodies << ", max_growth " << options.max_growth << ", edge_weight "
       << name_of(options.edge_weight) << ", as_printed " << options.as_printed;
  return text.str();
}

std::string first_difference(const Partition& expected, const Partition& actual) {
  std::ostringstream text;
  if (expected.part_of_body.size() != actual.part_of_body.size()) {
    text << "bodies: expected " << expected.part_of_body.size() << ", got " << actual.part_of_body.size();
    return text.str();
  }
  for (std::size_t body = 0; body < expected.part_of_body.size(); ++body) {
    if (expected.part_of_body[body] == actual.part_of_body[body]) continue;
    text << "body " << body << ": expected part " << expected.part_of_body[body] << ", got "
         << actual.part_of_body[body];
    return text.str();
  }
  if (expected.part_count != actual.part_count) {
    text << "part_count: expected " << expected.part_count << ", got " << actual.part_count;
  }
  return text.str();
}

}  // namespace cleave::partition_test
