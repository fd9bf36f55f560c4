// The counted work of cost_features.h, the slow and obvious way: matrices of truth values, and forward
// substitutions of single right-hand sides on their pattern.
#pragma once

#include <span>
#include <vector>

#include "partition/cost_features.h"
#include "partition/partition.h"
#include "tests/partition/paper_options.h"

namespace cleave::partition_test {

// The pattern of the factor of some bodies, in order of elimination.
struct SlowFactor {
  std::vector<int> order;                // bodies
  std::vector<std::vector<char>> lower;  // [row][column], by place in `order`, the diagonal set
  int below(int column) const;
};
SlowFactor slow_factor(const BodyGraph& graph, std::span<const int> bodies,
                       std::span<const int> stage_of_body);

// separator_nodes of cut_cover.h: node by node from the root, the body with the most open edges looked for
// among all.
std::vector<int> slow_separator_nodes(const BodyGraph& graph, const Partition& partition);

CostFeatures slow_cost_features(const BodyGraph& graph, const Partition& partition, CostKernel kernel,
                                double active_share);

// fm-cost at its defaults: every candidate is a partition of its own, counted from scratch.
RefineSummary slow_fm_cost(const BodyGraph& graph, const RefineOptions& options, Partition& partition);

}  // namespace cleave::partition_test
