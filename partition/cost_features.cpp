#include "partition/cost_features.h"

#include <cmath>
#include <numeric>

#include "partition/cut_cover.h"

namespace cleave {
namespace {

constexpr const char* kNames[] = {"schur-rows", "schur-bodies", "schur-nested", "monolithic"};

// Rows of a body to bodies of the same part, counted at the lower one, and to others.
struct BodyRows {
  int inside = 0, cut = 0;
};

BodyRows rows_of(const BodyGraph& graph, int body, std::span<const int> part_of_body) {
  BodyRows rows{graph.fixed_rows(body), 0};
  for (int k = graph.first(body); k < graph.last(body); ++k) {
    const int other = graph.neighbour(k), weight = graph.weight(k, EdgeWeight::rows);
    if (part_of_body[other] != part_of_body[body]) {
      rows.cut += weight;
    } else if (body < other) {
      rows.inside += weight;
    }
  }
  return rows;
}

void add_column(const EliminatedColumn& column, PartCost& part) {
  part.factor_flops += column_flops(column.below);
  part.blocks += 1 + column.below;
  part.entries += 36.0 * (1 + column.below);
}

double mass_spread_of(const BodyGraph& graph) {
  double mean = 0, square = 0;
  const int n = graph.body_count();
  for (int body = 0; body < n; ++body) mean += std::log(graph.mass_kg(body)) / n;
  for (int body = 0; body < n; ++body) square += std::pow(std::log(graph.mass_kg(body)) - mean, 2) / n;
  return std::sqrt(square);
}

}  // namespace

std::span<const char* const> cost_kernel_names() { return kNames; }

CostCounter::CostCounter(const BodyGraph& graph, CostKernel kernel, double active_share)
    : graph_(graph),
      kernel_(kernel),
      active_share_(active_share),
      mass_spread_(mass_spread_of(graph)),
      eliminator_(graph) {
  for (int i = 0; i < graph.body_count(); ++i) fixed_rows_ += graph.fixed_rows(i);
}

CostFeatures CostCounter::count(const Partition& partition) {
  CostFeatures features;
  features.kernel = kernel_;
  features.bodies = graph_.body_count();
  features.edges = graph_.edge_count();
  features.mass_spread = mass_spread_;
  features.fixed_rows = fixed_rows_;
  if (kernel_ == CostKernel::schur_rows) {
    count_parts(partition, features);
  } else if (kernel_ == CostKernel::monolithic) {
    count_whole({std::vector<int>(graph_.body_count(), 0), graph_.body_count() > 0}, features);
  } else {
    count_whole(partition, features);
  }
  for (const PartCost& part : features.parts) features.rows += part.rows;
  features.rows += features.cut_rows;
  return features;
}

PartCost CostCounter::count_part(std::span<const int> bodies, std::span<const int> part_of_body) {
  PartCost part;
  const std::span<const EliminatedColumn> columns = eliminator_.run(bodies);
  sides_.assign(columns.size(), 0.0);
  for (std::size_t p = 0; p < columns.size(); ++p) {
    const BodyRows rows = rows_of(graph_, columns[p].body, part_of_body);
    ++part.bodies;
    part.rows += rows.inside;
    part.cut_rows += rows.cut;
    sides_[p] += active_share_ * rows.cut;
    const double sides = sides_[p];  // children stand before their parents
    if (columns[p].parent >= 0) sides_[columns[p].parent] += sides;
    add_column(columns[p], part);
    part.form_flops += (36 + 72.0 * columns[p].below) * sides + 6 * sides * sides;
    part.entries += 6 * sides;
  }
  return part;
}

void CostCounter::set_interface(int cut_rows, CostFeatures& features) const {
  const double unknowns = active_share_ * cut_rows;
  features.cut_rows = cut_rows;
  features.interface_unknowns = unknowns;
  features.interface_flops = unknowns * (unknowns + 1) * (2 * unknowns + 1) / 6;
  features.interface_entries = unknowns * (unknowns + 1) / 2;
}

void CostCounter::count_parts(const Partition& partition, CostFeatures& features) {
  std::vector<std::vector<int>> bodies(partition.part_count);
  for (int i = 0; i < graph_.body_count(); ++i) bodies[partition.part_of_body[i]].push_back(i);
  int sides = 0;
  for (const std::vector<int>& part : bodies) {
    features.parts.push_back(count_part(part, partition.part_of_body));
    sides += features.parts.back().cut_rows;
  }
  set_interface(sides / 2, features);
}

void CostCounter::count_whole(const Partition& partition, CostFeatures& features) {
  const std::vector<int>& part_of_body = partition.part_of_body;
  std::span<const int> tree;  // empty: one level
  if (kernel_ == CostKernel::schur_nested) tree = partition.parent_of_part;
  const std::vector<int> node = separator_nodes(graph_, part_of_body, partition.part_count, tree);
  const auto is_interface = [&](int body) { return node[body] >= partition.part_count; };
  features.parts.resize(partition.part_count);
  std::vector<int> bodies(graph_.body_count());
  std::iota(bodies.begin(), bodies.end(), 0);
  for (const int body : bodies) {
    const BodyRows rows = rows_of(graph_, body, part_of_body);
    PartCost& part = features.parts[part_of_body[body]];
    ++part.bodies;
    part.rows += rows.inside;
    part.cut_rows += rows.cut;
    features.cut_rows += rows.cut;
    features.cover_bodies += is_interface(body);
  }
  features.cut_rows /= 2;
  features.interface_unknowns = 6.0 * features.cover_bodies;
  PartCost interface;
  for (const EliminatedColumn& column : eliminator_.run(bodies, node))
    add_column(column, is_interface(column.body) ? interface : features.parts[part_of_body[column.body]]);
  features.interface_flops = interface.factor_flops;
  features.interface_entries = interface.entries;
  features.interface_blocks = interface.blocks;
}

}  // namespace cleave
