#include "partition/partition_cost.h"

#include <algorithm>
#include <utility>

namespace cleave {

PartitionCost::PartitionCost(const BodyGraph& graph, const KernelCost& cost, const Partition& start)
    : cost_(cost),
      counter_(cost_counter(graph, cost)),
      partition_(start),
      bodies_(start.part_count),
      features_(counter_.count(start)),
      ms_(modelled_ms(features_, cost_)) {
  for (int i = 0; i < graph.body_count(); ++i) bodies_[start.part_of_body[i]].push_back(i);
}

void PartitionCost::move(int body, int part) {
  std::vector<int>& from = bodies_[std::exchange(partition_.part_of_body[body], part)];
  from.erase(std::ranges::lower_bound(from, body));
  bodies_[part].insert(std::ranges::lower_bound(bodies_[part], body), body);
}

// Whether the features at hand take less time than those before them.
bool PartitionCost::is_cheaper() {
  const double ms = modelled_ms(features_, cost_);
  if (ms >= ms_) return false;
  ms_ = ms;
  return true;
}

// Only two parts are counted and, where that was in vain, put back: there may be thousands.
bool PartitionCost::count_parts(int from, int to) {
  const PartCost former_from = features_.parts[from], former_to = features_.parts[to];
  const int former_cut_rows = features_.cut_rows;
  int sides = 2 * former_cut_rows;
  for (const int part : {from, to}) {
    sides -= features_.parts[part].cut_rows;
    features_.parts[part] = counter_.count_part(bodies_[part], partition_.part_of_body);
    sides += features_.parts[part].cut_rows;
  }
  counter_.set_interface(sides / 2, features_);
  if (is_cheaper()) return true;
  features_.parts[from] = former_from;
  features_.parts[to] = former_to;
  counter_.set_interface(former_cut_rows, features_);
  return false;
}

bool PartitionCost::count_all() {
  CostFeatures former = std::exchange(features_, counter_.count(partition_));
  if (is_cheaper()) return true;
  features_ = std::move(former);
  return false;
}

bool PartitionCost::move_if_cheaper(int body, int part) {
  const int from = partition_.part_of_body[body];
  move(body, part);
  if (cost_.kernel == CostKernel::schur_rows ? count_parts(from, part) : count_all()) return true;
  move(body, from);
  return false;
}

}  // namespace cleave
