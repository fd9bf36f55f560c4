// The counted work of cost_features.h, the slow and obvious way: matrices of truth values, and forward substitutions of
// single right-hand sides on their pattern.
#pragma once

#include <span>
#include <vector>

#include "partition/cost_features.h"

namespace cleave::partition_test {

// The pattern of the factor of some bodies, in order of elimination.
struct SlowFactor {
  std::vector<int> order;                // bodies
  std::vector<std::vector<char>> lower;  // [row][column], by place in `order`, the diagonal set
  int below(int column) const;
};
SlowFactor slow_factor(const BodyGraph& graph, std::span<const int> bodies, std::span<const char> is_last);

CostFeatures slow_cost_features(const BodyGraph& graph, std::span<const int> part_of_body, int part_count,
                                CostKernel kernel, double active_share);

}  // namespace cleave::partition_test
