#include "tests/partition/slow_mending.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <tuple>
#include <vector>

#include "tests/partition/slow_hill.h"
#include "tests/partition/slow_leftovers.h"

namespace cleave::partition_test {
namespace {

// As merge_small.cpp has them.
constexpr int kPatience = 10;
constexpr int kMostRounds = 10;

// The part, other than `but`, of fewest bodies.
int smallest(const Partition& partition, int but) {
  int found = -1;
  for (int part = 0; part < partition.part_count; ++part)
    if (part != but && (found < 0 || bodies_in(partition, part) < bodies_in(partition, found))) found = part;
  return found;
}

// The body of that part to be placed next and where.
std::pair<int, int> next_to_place(const Bodies& bodies, const Partition& partition, int part,
                                  int most_bodies) {
  std::optional<std::tuple<long, int, int>> best;  // - gain, body, part
  for (int body = 0; body < bodies.count(); ++body) {
    if (partition.part_of_body[body] != part) continue;
    for (int other = 0; other < partition.part_count; ++other) {
      const long into = rows_into(bodies, partition, body, other);
      if (other == part || into == 0 || bodies_in(partition, other) >= most_bodies) continue;
      const std::tuple found{rows_into(bodies, partition, body, part) - into, body, other};
      if (!best || found < *best) best = found;
    }
  }
  if (best) return {std::get<1>(*best), std::get<2>(*best)};
  const auto lowest = std::ranges::find(partition.part_of_body, part) - partition.part_of_body.begin();
  return {static_cast<int>(lowest), smallest(partition, part)};
}

long cut_rows(const Bodies& bodies, const Partition& partition) {
  long rows = 0;
  for (const ConstraintLink& link : bodies.links)
    if (link.body_a >= 0 && link.body_b >= 0 &&
        partition.part_of_body[link.body_a] != partition.part_of_body[link.body_b])
      rows += link.rows;
  return rows;
}

}  // namespace

int slow_dissolve_smallest(const Bodies& bodies, int parts, int most_bodies, Partition& partition) {
  int dissolved = 0;
  for (; partition.part_count > parts; ++dissolved) {
    const int part = smallest(partition, -1);
    while (bodies_in(partition, part) > 0) {
      const auto [body, into] = next_to_place(bodies, partition, part, most_bodies);
      partition.part_of_body[body] = into;
    }
    for (int& id : partition.part_of_body) id -= id > part;
    --partition.part_count;
  }
  return dissolved;
}

int slow_climb_locally(const Bodies& bodies, const LocalClimbs& options, Partition& partition) {
  const BodyGraph graph = bodies.graph();
  const SlowClimb climb{graph, EdgeWeight::rows, options.most_bodies, options.patience};
  std::set<int> looks_at;
  for (int body = 0; body < bodies.count(); ++body) looks_at.insert(body);
  int moves = 0;
  for (int round = 0; round < options.most_rounds && !looks_at.empty(); ++round) {
    std::set<int> stay;
    for (const int body : looks_at) stay.merge(climb.run({body}, stay, partition));
    moves += static_cast<int>(stay.size());
    looks_at = stay;
    for (const int body : stay)
      for (const int other : graph.neighbours(body)) looks_at.insert(other);
  }
  return moves;
}

Partition slow_mend(const Bodies& bodies, int max_bodies, const Partition& grown) {
  const int wanted = static_cast<int>(std::ceil(static_cast<double>(bodies.count()) / max_bodies));
  const int most = static_cast<int>(std::floor(1.2 * max_bodies + 1e-9));
  const LocalClimbs climbs{most, kPatience, kMostRounds};
  Partition joined = grown;
  slow_join_leftovers(bodies, {wanted, static_cast<int>(std::ceil(max_bodies / 2.0)), most}, joined);
  Partition fewer = joined;
  slow_dissolve_smallest(bodies, wanted, most, fewer);
  slow_climb_locally(bodies, climbs, fewer);
  if (cut_rows(bodies, fewer) <= cut_rows(bodies, joined)) return fewer;
  slow_climb_locally(bodies, climbs, joined);
  return joined;
}

}  // namespace cleave::partition_test
