// The recursive contraction algorithm for minimum cuts (Karger & Stein, A new approach to the minimum cut
// problem, Journal of the ACM 43, 1996, section 4): a graph of n nodes is contracted to
//
//     ceil(n / sqrt(2) + 1)
//
// nodes twice, the algorithm runs on both, and the lighter of the two cuts counts, the first on ties. A graph
// of at most six nodes is contracted to two, which are the cut. A minimum cut is found with probability
// Omega(1 / log n), which is greater than that of one contraction to two nodes, 2 / (n (n - 1)).
//
// After each contraction the edges between the same two nodes become one, with the sum of their weights.
#pragma once

#include <span>
#include <vector>

#include "partition/contraction.h"

namespace cleave {

struct MinimumCut {
  long weight = 0;
  std::vector<int> side_of_node;  // (nodes) 0 or 1; node 0 is on side 0. Both sides are connected
};

// Of a connected graph of at least two nodes, edges ascending by a, then by b.
MinimumCut karger_stein(int nodes, std::span<const WeightedEdge> edges, Dice& dice);

}  // namespace cleave
