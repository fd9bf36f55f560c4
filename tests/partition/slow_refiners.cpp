// The refiners of Liu & Andrews 2022, section 3.2. For a body i of part A and a part B: E_i = edge weight
// from i into B, I_i = from i into the rest of A, c_ij = weight of the edge (i, j) or 0. Every round lists
// all exchanges, makes the best one, and starts again, until no gain is positive.
#include <cmath>
#include <optional>
#include <tuple>

#include "tests/partition/slow_cost.h"
#include "tests/partition/slow_hill.h"
#include "tests/partition/slow_twins.h"

namespace cleave::partition_test {
namespace {

EdgeWeight unit_of(const RefineOptions& options) {
  return options.as_printed ? EdgeWeight::pairs : options.edge_weight;
}

long total_cut(const BodyGraph& graph, const Partition& partition, EdgeWeight unit) {
  long twice = 0;
  for (int body = 0; body < graph.body_count(); ++body) {
    for (int half = graph.first(body); half < graph.last(body); ++half) {
      const bool cut = partition.part_of_body[body] != partition.part_of_body[graph.neighbour(half)];
      if (cut) twice += graph.weight(half, unit);
    }
  }
  return twice / 2;
}

long weight_between(const BodyGraph& graph, int body, int other, EdgeWeight unit) {
  for (int half = graph.first(body); half < graph.last(body); ++half) {
    if (graph.neighbour(half) == other) return graph.weight(half, unit);
  }
  return 0;
}

// [body][part]: total edge weight from the body into the part.
using PartWeights = std::vector<std::vector<long>>;

PartWeights weights_into_parts(const BodyGraph& graph, const Partition& partition, EdgeWeight unit) {
  PartWeights into(graph.body_count(), std::vector<long>(partition.part_count, 0));
  for (int body = 0; body < graph.body_count(); ++body) {
    for (int half = graph.first(body); half < graph.last(body); ++half) {
      into[body][partition.part_of_body[graph.neighbour(half)]] += graph.weight(half, unit);
    }
  }
  return into;
}

std::vector<std::vector<int>> members_of_parts(const Partition& partition) {
  std::vector<std::vector<int>> members(partition.part_count);
  for (int body = 0; body < static_cast<int>(partition.part_of_body.size()); ++body) {
    members[partition.part_of_body[body]].push_back(body);
  }
  return members;
}

RefineSummary none(const BodyGraph& graph, const RefineOptions& options, Partition& partition) {
  const long cut = total_cut(graph, partition, unit_of(options));
  return {0, cut, cut};
}

// Kernighan-Lin swap. The best one has the lowest key: greatest gain, lowest body, lowest other body. The two
// bodies fix the two parts.
struct Swap {
  long gain;
  int low_body;
  int high_body;
  auto key() const { return std::tuple(-gain, low_body, high_body); }
};

std::optional<Swap> best_swap(const BodyGraph& graph, const Partition& partition, EdgeWeight unit) {
  const PartWeights into = weights_into_parts(graph, partition, unit);
  const std::vector<std::vector<int>> members = members_of_parts(partition);
  std::optional<Swap> best;
  for (int a = 0; a < partition.part_count; ++a) {
    for (int b = a + 1; b < partition.part_count; ++b) {
      for (int i : members[a]) {
        if (into[i][b] == 0) continue;
        for (int j : members[b]) {
          if (into[j][a] == 0) continue;
          const long gain =
              (into[i][b] - into[i][a]) + (into[j][a] - into[j][b]) - 2 * weight_between(graph, i, j, unit);
          const Swap swap{gain, std::min(i, j), std::max(i, j)};
          if (gain > 0 && (!best || swap.key() < best->key())) best = swap;
        }
      }
    }
  }
  return best;
}

RefineSummary kernighan_lin(const BodyGraph& graph, const RefineOptions& options, Partition& partition) {
  const EdgeWeight unit = unit_of(options);
  RefineSummary summary;
  summary.cut_before = total_cut(graph, partition, unit);
  while (const std::optional<Swap> swap = best_swap(graph, partition, unit)) {
    std::swap(partition.part_of_body[swap->low_body], partition.part_of_body[swap->high_body]);
    ++summary.exchanges;
  }
  summary.cut_after = total_cut(graph, partition, unit);
  return summary;
}

// Fiduccia-Mattheyses move. The best one has the lowest key: greatest gain, lowest body, lowest target part.
struct Move {
  long gain;
  int body;
  int target;
  auto key() const { return std::tuple(-gain, body, target); }
};

std::optional<Move> best_move(const BodyGraph& graph, const RefineOptions& options,
                              const Partition& partition) {
  const PartWeights into = weights_into_parts(graph, partition, unit_of(options));
  const std::vector<std::vector<int>> members = members_of_parts(partition);
  const double most_bodies = std::floor((1 + options.max_growth) * options.max_bodies + 1e-9);
  std::optional<Move> best;
  for (int body = 0; body < graph.body_count(); ++body) {
    const int source = partition.part_of_body[body];
    if (members[source].size() == 1) continue;
    for (int target = 0; target < partition.part_count; ++target) {
      if (target == source || into[body][target] == 0) continue;
      if (!options.as_printed && members[target].size() + 1 > most_bodies) continue;
      const Move move{into[body][target] - into[body][source], body, target};
      if (move.gain > 0 && (!best || move.key() < best->key())) best = move;
    }
  }
  return best;
}

RefineSummary fiduccia_mattheyses(const BodyGraph& graph, const RefineOptions& options,
                                  Partition& partition) {
  const EdgeWeight unit = unit_of(options);
  RefineSummary summary;
  summary.cut_before = total_cut(graph, partition, unit);
  while (const std::optional<Move> move = best_move(graph, options, partition)) {
    partition.part_of_body[move->body] = move->target;
    ++summary.exchanges;
  }
  summary.cut_after = total_cut(graph, partition, unit);
  return summary;
}

constexpr RefinerTwin kRefiners[] = {{"none", none},
                                     {"kl", kernighan_lin},
                                     {"fm", fiduccia_mattheyses},
                                     {"kl-hill", slow_kl_hill},
                                     {"fm-hill", slow_fm_hill},
                                     {"fm-cost", slow_fm_cost}};

}  // namespace

std::span<const RefinerTwin> refiner_twins() { return kRefiners; }

}  // namespace cleave::partition_test
