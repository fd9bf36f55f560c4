#include "tests/partition/slow_leftovers.h"

#include <algorithm>
#include <optional>
#include <tuple>
#include <utility>

namespace cleave::partition_test {
namespace {

long rows_between(const Bodies& bodies, const Partition& partition, int part, int other) {
  long rows = 0;
  for (const ConstraintLink& link : bodies.links) {
    if (link.body_a < 0 || link.body_b < 0) continue;
    const int a = partition.part_of_body[link.body_a], b = partition.part_of_body[link.body_b];
    if ((a == part && b == other) || (a == other && b == part)) rows += link.rows;
  }
  return rows;
}

// The next part to be joined and with which; ids are those of the parts that are there now.
std::optional<std::pair<int, int>> next_to_join(const Bodies& bodies, const Partition& partition,
                                                const LeftoverBounds& bounds) {
  std::optional<std::tuple<int, int, long, int>> best;  // bodies, part, - rows, other
  for (int part = 0; part < partition.part_count; ++part) {
    const int size = bodies_in(partition, part);
    if (size >= bounds.small_bodies) continue;
    for (int other = 0; other < partition.part_count; ++other) {
      if (other == part || size + bodies_in(partition, other) > bounds.most_bodies) continue;
      const long rows = rows_between(bodies, partition, part, other);
      const std::tuple found{size, part, -rows, other};
      if (rows > 0 && (!best || found < *best)) best = found;
    }
  }
  if (!best) return std::nullopt;
  return std::pair{std::get<1>(*best), std::get<3>(*best)};
}

}  // namespace

int slow_join_leftovers(const Bodies& bodies, const LeftoverBounds& bounds, Partition& parts) {
  int joined = 0;
  while (parts.part_count > bounds.parts) {
    const auto pair = next_to_join(bodies, parts, bounds);
    if (!pair) break;
    const auto [low, high] = std::minmax(pair->first, pair->second);
    for (int& part : parts.part_of_body) part = part == high ? low : part - (part > high);
    --parts.part_count;
    ++joined;
  }
  return joined;
}

}  // namespace cleave::partition_test
