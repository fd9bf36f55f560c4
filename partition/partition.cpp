#include "partition/partition.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "partition/cut_cover.h"
#include "partition/refuse.h"

namespace cleave {
namespace {

void check_part_ids(const BodyGraph& graph, std::span<const int> part_of_body) {
  const int n = graph.body_count();
  if (static_cast<int>(part_of_body.size()) != n) refuse("size of part_of_body", part_of_body.size(), n);
  for (int i = 0; i < n; ++i) {
    if (part_of_body[i] >= 0 && part_of_body[i] < n) continue;
    refuse("part_of_body of body " + std::to_string(i), part_of_body[i], "0 to " + std::to_string(n - 1));
  }
}

}  // namespace

std::string_view kernel_of_choice(std::string_view choice) { return choice.substr(choice.rfind('/') + 1); }

Partition numbered_by_lowest_body(std::span<const int> label_of_body) {
  Partition partition;
  std::vector<int> part_of_label(label_of_body.size(), -1);
  for (const int label : label_of_body) {
    if (part_of_label[label] < 0) part_of_label[label] = partition.part_count++;
    partition.part_of_body.push_back(part_of_label[label]);
  }
  return partition;
}

PartitionMetrics measure_partition(const BodyGraph& graph, std::span<const int> part_of_body) {
  check_part_ids(graph, part_of_body);
  const int n = graph.body_count();
  PartitionMetrics metrics;
  metrics.cut_pairs = static_cast<int>(cut_weight(graph, part_of_body, EdgeWeight::pairs));
  metrics.cut_constraints = static_cast<int>(cut_weight(graph, part_of_body, EdgeWeight::constraints));
  metrics.interface_rows = static_cast<int>(cut_weight(graph, part_of_body, EdgeWeight::rows));

  std::vector<int> bodies(n, 0);
  std::vector<double> lightest_kg(n, std::numeric_limits<double>::infinity()), heaviest_kg(n, 0.0);
  for (int i = 0; i < n; ++i) {
    const int part = part_of_body[i];
    ++bodies[part];
    lightest_kg[part] = std::min(lightest_kg[part], graph.mass_kg(i));
    heaviest_kg[part] = std::max(heaviest_kg[part], graph.mass_kg(i));
  }
  for (int part = 0; part < n; ++part) {
    if (bodies[part] == 0) continue;
    ++metrics.parts;
    metrics.max_part_bodies = std::max(metrics.max_part_bodies, bodies[part]);
    metrics.part_mass_ratio_max =
        std::max(metrics.part_mass_ratio_max, heaviest_kg[part] / lightest_kg[part]);
  }
  metrics.contiguous = count_pieces(graph, part_of_body) == metrics.parts;

  for (int i = 0; i < n; ++i)
    metrics.interface_bodies += std::ranges::any_of(
        graph.neighbours(i), [&](int other) { return part_of_body[other] != part_of_body[i]; });
  const std::vector<char> cover = cut_cover(graph, part_of_body);
  metrics.interface_cover_bodies = static_cast<int>(std::count(cover.begin(), cover.end(), 1));
  return metrics;
}

// From both sides of every edge, without branches, which would be guessed wrong.
long cut_weight(const BodyGraph& graph, std::span<const int> part_of_body, EdgeWeight unit) {
  long twice = 0;
  for (int i = 0; i < graph.body_count(); ++i) {
    const int own = part_of_body[i];
    for (int k = graph.first(i); k < graph.last(i); ++k)
      twice += static_cast<int>(part_of_body[graph.neighbour(k)] != own) * graph.weight(k, unit);
  }
  return twice / 2;
}

int most_grown_bodies(int max_bodies, double max_growth) {
  const double most = std::numeric_limits<int>::max();
  return static_cast<int>(std::min(most, std::floor((1 + max_growth) * max_bodies + 1e-9)));
}

std::vector<int> part_sizes(const Partition& partition) {
  std::vector<int> sizes(partition.part_count, 0);
  for (int part : partition.part_of_body) ++sizes[part];
  return sizes;
}

}  // namespace cleave
