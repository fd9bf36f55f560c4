#include "partition/partition_cost.h"

#include <algorithm>
#include <utility>

namespace cleave {

PartitionCost::PartitionCost(const BodyGraph& graph, const KernelCost& cost, const Partition& start)
    : cost_(cost),
      counter_(graph, cost.kernel, cost.active_share),
      partition_(start),
      bodies_(start.part_count),
      features_(counter_.count(start.part_of_body, start.part_count)),
      ms_(modelled_ms(features_, cost_)) {
  for (int i = 0; i < graph.body_count(); ++i) bodies_[start.part_of_body[i]].push_back(i);
}

void PartitionCost::move(int body, int part) {
  std::vector<int>& from = bodies_[std::exchange(partition_.part_of_body[body], part)];
  from.erase(std::ranges::lower_bound(from, body));
  bodies_[part].insert(std::ranges::lower_bound(bodies_[part], body), body);
}

CostFeatures PartitionCost::features_after(int from, int to) {
  if (cost_.kernel != CostKernel::schur_rows)
    return counter_.count(partition_.part_of_body, partition_.part_count);
  CostFeatures features = features_;
  int sides = 2 * features.cut_rows;
  for (const int part : {from, to}) {
    sides -= features.parts[part].cut_rows;
    features.parts[part] = counter_.count_part(bodies_[part], partition_.part_of_body);
    sides += features.parts[part].cut_rows;
  }
  counter_.set_interface(sides / 2, features);
  return features;
}

bool PartitionCost::move_if_cheaper(int body, int part) {
  const int from = partition_.part_of_body[body];
  move(body, part);
  CostFeatures features = features_after(from, part);
  const double ms = modelled_ms(features, cost_);
  if (ms >= ms_) {
    move(body, from);
    return false;
  }
  features_ = std::move(features);
  ms_ = ms;
  return true;
}

}  // namespace cleave
