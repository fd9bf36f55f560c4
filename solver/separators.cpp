#include "solver/separators.h"

#include <algorithm>

#include "solver/counting_sort.h"
#include "solver/parts.h"
#include "solver/vertex_cover.h"

namespace cleave {

void Separators::find(const PreparedStep& step, const Parts& parts) {
  read_tree(parts);
  node_of_body_.assign(parts.part_of_body.begin(), parts.part_of_body.end());
  local_of_body_.assign(step.body_count(), -1);
  sort_edges(step, parts.part_of_body);
  for (int node = node_count_ - 1; node >= part_count_; --node) cover(node);
}

void Separators::read_tree(const Parts& parts) {
  part_count_ = count_parts(parts.part_of_body);
  if (parts.parent_of_part.empty()) {
    node_count_ = part_count_ + 1;
    parent_.assign(node_count_, part_count_);
  } else {
    node_count_ = static_cast<int>(parts.parent_of_part.size());
    parent_.assign(parts.parent_of_part.begin(), parts.parent_of_part.end());
    parent_.back() = node_count_ - 1;
  }
  depth_.assign(node_count_, 0);
  for (int node = node_count_ - 2; node >= 0; --node) depth_[node] = depth_[parent_[node]] + 1;
}

// The lowest node that both are below.
int Separators::node_above(int a, int b) const {
  while (a != b) {
    if (depth_[a] >= depth_[b]) {
      a = parent_[a];
    } else {
      b = parent_[b];
    }
  }
  return a;
}

void Separators::sort_edges(const PreparedStep& step, std::span<const int> part_of_body) {
  edges_.clear();
  node_of_edge_.clear();
  for (const RowGroup& group : step.groups()) {
    if (group.body_b < 0) continue;
    const int a = part_of_body[group.body_a], b = part_of_body[group.body_b];
    if (a == b) continue;
    edges_.emplace_back(group.body_a, group.body_b);
    node_of_edge_.push_back(node_above(a, b));
  }
  sort_into_buckets(
      static_cast<int>(edges_.size()), node_count_, [this](int edge) { return node_of_edge_[edge]; },
      edge_first_, edge_order_);
}

// Bodies are numbered anew, in their order, so that the work follows the size of the cut.
void Separators::cover(int node) {
  bodies_.clear();
  local_edges_.clear();
  for (int k = edge_first_[node]; k < edge_first_[node + 1]; ++k) {
    const auto [a, b] = edges_[edge_order_[k]];
    if (node_of_body_[a] >= part_count_ || node_of_body_[b] >= part_count_) continue;  // covered above
    local_edges_.emplace_back(a, b);
    bodies_.insert(bodies_.end(), {a, b});
  }
  std::ranges::sort(bodies_);
  bodies_.erase(std::unique(bodies_.begin(), bodies_.end()), bodies_.end());
  for (std::size_t k = 0; k < bodies_.size(); ++k) local_of_body_[bodies_[k]] = static_cast<int>(k);
  for (auto& [a, b] : local_edges_) a = local_of_body_[a], b = local_of_body_[b];
  const std::vector<char> cover = vertex_cover(static_cast<int>(bodies_.size()), local_edges_);
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    if (cover[k]) node_of_body_[bodies_[k]] = node;
  }
}

}  // namespace cleave
