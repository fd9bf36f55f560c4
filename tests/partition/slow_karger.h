// The definitions of partition/contraction.h, karger_stein.h and karger.cpp with weight matrices and lists,
// every number computed anew. Only the dice are shared with what is checked, so that equal dice give equal
// partitions.
#pragma once

#include <vector>

#include "harness/base/dice.h"
#include "tests/partition/brute_force.h"
#include "tests/partition/test_graphs.h"

namespace cleave::partition_test {

struct SlowContraction {
  std::vector<int> node_of_body;  // the lowest body of each one's node
  int refused = 0;
};

SlowContraction slow_contract(const WeightMatrix& weights, int nodes, int most_bodies, Dice& dice);

// On side 0 or 1 of a cut, with node 0 on side 0.
std::vector<int> slow_karger_stein(const WeightMatrix& weights, Dice& dice);

struct KargerOptions {
  int max_bodies;
  double max_growth;
  EdgeWeight unit;
  int seed;
  int trials;
  bool bisects;
};

Partition slow_karger(const Bodies& bodies, const KargerOptions& options);

// Of a side of 0 and 1.
long weight_between(const WeightMatrix& weights, const std::vector<int>& side_of_node);

// The least over all bipartitions.
long least_cut(const WeightMatrix& weights);

}  // namespace cleave::partition_test
