#include "tests/partition/slow_cost.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "partition/calibration.h"

namespace cleave::partition_test {
namespace {

double squared_heights(int below) {
  double sum = 0;
  for (int height = 6 * below + 1; height <= 6 * below + 6; ++height) sum += 1.0 * height * height;
  return sum;
}

// Columns that a right-hand side with an entry at one body fills in a forward substitution.
std::vector<char> filled_by(const SlowFactor& factor, int place) {
  std::vector<char> filled(factor.order.size(), 0);
  filled[place] = 1;
  for (std::size_t column = 0; column < filled.size(); ++column)
    for (std::size_t row = column + 1; row < filled.size(); ++row)
      if (filled[column] && factor.lower[row][column]) filled[row] = 1;
  return filled;
}

int cut_rows_of(const BodyGraph& graph, int body, std::span<const int> part_of_body) {
  int rows = 0;
  for (int k = graph.first(body); k < graph.last(body); ++k)
    if (part_of_body[graph.neighbour(k)] != part_of_body[body]) rows += graph.weight(k, EdgeWeight::rows);
  return rows;
}

void count_rows(const BodyGraph& graph, std::span<const int> part_of_body, CostFeatures& features) {
  for (int i = 0; i < graph.body_count(); ++i) {
    PartCost& part = features.parts[part_of_body[i]];
    ++part.bodies;
    part.rows += graph.fixed_rows(i);
    features.rows += graph.fixed_rows(i);
    features.fixed_rows += graph.fixed_rows(i);
    ++features.bodies;
    for (int k = graph.first(i); k < graph.last(i); ++k) {
      const int j = graph.neighbour(k), rows = graph.weight(k, EdgeWeight::rows);
      if (part_of_body[i] != part_of_body[j]) part.cut_rows += rows;
      if (j < i) continue;
      features.rows += rows;
      ++features.edges;
      (part_of_body[i] == part_of_body[j] ? part.rows : features.cut_rows) += rows;
    }
  }
}

void add_columns(const SlowFactor& factor, int column, PartCost& part) {
  part.factor_flops += squared_heights(factor.below(column));
  part.blocks += 1 + factor.below(column);
  part.entries += 36.0 * (1 + factor.below(column));
}

void count_part(const BodyGraph& graph, std::span<const int> part_of_body, int id, double active_share,
                PartCost& part) {
  std::vector<int> bodies;
  for (int i = 0; i < graph.body_count(); ++i)
    if (part_of_body[i] == id) bodies.push_back(i);
  const SlowFactor factor = slow_factor(graph, bodies, {});
  std::vector<double> sides(bodies.size(), 0.0);
  for (std::size_t place = 0; place < bodies.size(); ++place) {
    const std::vector<char> filled = filled_by(factor, static_cast<int>(place));
    for (std::size_t column = 0; column < filled.size(); ++column)
      if (filled[column])
        sides[column] += active_share * cut_rows_of(graph, factor.order[place], part_of_body);
  }
  for (std::size_t column = 0; column < bodies.size(); ++column) {
    const int below = factor.below(static_cast<int>(column));
    add_columns(factor, static_cast<int>(column), part);
    part.form_flops += sides[column] * (36 + 72 * below) + 6 * sides[column] * sides[column];
    part.entries += 6 * sides[column];
  }
}

}  // namespace

int SlowFactor::below(int column) const {
  int blocks = 0;
  for (std::size_t row = column + 1; row < order.size(); ++row) blocks += lower[row][column];
  return blocks;
}

SlowFactor slow_factor(const BodyGraph& graph, std::span<const int> bodies,
                       std::span<const int> stage_of_body) {
  const int n = static_cast<int>(bodies.size());
  std::vector<std::vector<char>> joined(n, std::vector<char>(n, 0));
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < n; ++b)
      for (const int other : graph.neighbours(bodies[a])) joined[a][b] |= other == bodies[b];
  std::vector<int> places;
  std::vector<char> done(n, 0);
  SlowFactor factor;
  for (int step = 0; step < n; ++step) {
    int best = -1;
    std::pair<int, int> least;  // (stage, degree)
    for (int a = 0; a < n; ++a) {
      if (done[a]) continue;
      std::pair<int, int> rank{stage_of_body.empty() ? 0 : stage_of_body[bodies[a]], 0};
      for (int b = 0; b < n; ++b) rank.second += !done[b] && joined[a][b];
      if (best < 0 || rank < least) best = a, least = rank;
    }
    done[best] = 1;
    places.push_back(best);
    for (int a = 0; a < n; ++a)
      for (int b = 0; b < n; ++b)
        if (a != b && !done[a] && !done[b] && joined[best][a] && joined[best][b]) joined[a][b] = 1;
  }
  factor.lower.assign(n, std::vector<char>(n, 0));
  for (int row = 0; row < n; ++row) {
    factor.order.push_back(bodies[places[row]]);
    for (int column = 0; column <= row; ++column)
      factor.lower[row][column] = row == column || joined[places[row]][places[column]];
  }
  return factor;
}

namespace {

// From the parent upwards; of one level the root is the part count.
std::vector<int> nodes_above(const Partition& partition, int node) {
  if (partition.parent_of_part.empty()) return {partition.part_count};
  std::vector<int> above;
  while ((node = partition.parent_of_part[node]) >= 0) above.push_back(node);
  return above;
}

// -1 where the edge is not cut.
int cutting_node(const Partition& partition, int part_a, int part_b) {
  if (part_a == part_b) return -1;
  const std::vector<int> above_b = nodes_above(partition, part_b);
  for (const int node : nodes_above(partition, part_a))
    if (std::ranges::count(above_b, node) > 0) return node;
  return -1;
}

}  // namespace

std::vector<int> slow_separator_nodes(const BodyGraph& graph, const Partition& partition) {
  const int n = graph.body_count();
  std::vector<int> node_of_body = partition.part_of_body;
  const int root = partition.parent_of_part.empty() ? partition.part_count
                                                    : static_cast<int>(partition.parent_of_part.size()) - 1;
  for (int node = root; node >= partition.part_count; --node) {
    while (true) {
      int best = -1, most = 0;
      for (int body = 0; body < n; ++body) {
        int open = 0;
        for (const int other : graph.neighbours(body))
          open +=
              node_of_body[body] < partition.part_count && node_of_body[other] < partition.part_count &&
              cutting_node(partition, partition.part_of_body[body], partition.part_of_body[other]) == node;
        if (open > most) best = body, most = open;
      }
      if (best < 0) break;
      node_of_body[best] = node;
    }
  }
  return node_of_body;
}

CostFeatures slow_cost_features(const BodyGraph& graph, const Partition& partition, CostKernel kernel,
                                double active_share) {
  const int n = graph.body_count();
  Partition split = partition;
  if (kernel == CostKernel::monolithic) split = {std::vector<int>(n, 0), n > 0};
  if (kernel != CostKernel::schur_nested) split.parent_of_part.clear();
  const std::vector<int>& parts = split.part_of_body;
  const int part_count = split.part_count;
  CostFeatures features;
  features.kernel = kernel;
  double mean = 0, mean_square = 0;
  for (int i = 0; i < n; ++i) {
    mean += std::log(graph.mass_kg(i)) / n;
    mean_square += std::log(graph.mass_kg(i)) * std::log(graph.mass_kg(i)) / n;
  }
  features.mass_spread = std::sqrt(std::max(0.0, mean_square - mean * mean));
  features.parts.resize(part_count);
  count_rows(graph, parts, features);
  if (kernel == CostKernel::schur_rows) {
    for (int id = 0; id < part_count; ++id) count_part(graph, parts, id, active_share, features.parts[id]);
    const double c = features.interface_unknowns = active_share * features.cut_rows;
    features.interface_flops = c * (c + 1) * (2 * c + 1) / 6;
    features.interface_entries = c * (c + 1) / 2;
    return features;
  }
  const std::vector<int> node = slow_separator_nodes(graph, split);
  std::vector<int> bodies(n);
  std::iota(bodies.begin(), bodies.end(), 0);
  const SlowFactor factor = slow_factor(graph, bodies, node);
  PartCost interface;
  for (int column = 0; column < n; ++column) {
    const int body = factor.order[column];
    features.cover_bodies += node[body] >= part_count;
    add_columns(factor, column, node[body] >= part_count ? interface : features.parts[parts[body]]);
  }
  features.interface_unknowns = 6.0 * features.cover_bodies;
  features.interface_flops = interface.factor_flops;
  features.interface_entries = interface.entries;
  features.interface_blocks = interface.blocks;
  return features;
}

namespace {

// Of a partition from scratch, counted by the counter that its own test compares with slow_cost_features.
double time_ms(const BodyGraph& graph, const Partition& partition) {
  static const KernelCost cost =
      known_calibration(read_calibration("calibration", "shipped")).of(CostKernel::schur_rows, 1);
  return modelled_ms(CostCounter(graph, cost.kernel, cost.active_share.of(graph)).count(partition), cost);
}

struct Move {
  long gain;
  int body, part;
};

// The allowed move of greatest gain among bodies that are free; ties to the lowest body, then to the lowest
// part.
bool find_move(const BodyGraph& graph, EdgeWeight unit, int most, const Partition& partition,
               const std::vector<char>& is_locked, Move& best) {
  const std::vector<int> sizes = part_sizes(partition);
  bool found = false;
  for (int body = 0; body < graph.body_count(); ++body) {
    const int own = partition.part_of_body[body];
    if (is_locked[body] || sizes[own] == 1) continue;
    std::map<int, long> into;
    for (int half = graph.first(body); half < graph.last(body); ++half)
      into[partition.part_of_body[graph.neighbour(half)]] += graph.weight(half, unit);
    for (const auto& [part, weight] : into) {
      const long gain = weight - into[own];
      if (part == own || sizes[part] >= most || (found && gain <= best.gain)) continue;
      best = {gain, body, part};
      found = true;
    }
  }
  return found;
}

}  // namespace

RefineSummary slow_fm_cost(const BodyGraph& graph, const RefineOptions& options, Partition& partition) {
  const long before = cut_weight(graph, partition.part_of_body, options.edge_weight);
  RefineSummary summary{0, before, before};
  const int most = static_cast<int>(std::floor((1 + options.max_growth) * options.max_bodies + 1e-9));
  for (bool moved = true; moved;) {
    moved = false;
    std::vector<char> is_locked(graph.body_count(), 0);
    for (Move move{}; find_move(graph, options.edge_weight, most, partition, is_locked, move);) {
      is_locked[move.body] = 1;
      Partition after = partition;
      after.part_of_body[move.body] = move.part;
      if (time_ms(graph, after) >= time_ms(graph, partition)) continue;
      partition = after;
      moved = true;
      ++summary.exchanges;
      summary.cut_after -= move.gain;
    }
  }
  return summary;
}

}  // namespace cleave::partition_test
