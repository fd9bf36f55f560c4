// Random contraction (Karger, Global min-cuts in RNC, and other ramifications of a simple min-cut algorithm,
// SODA 1993): edges are drawn one after the other without replacement, each with probability
//
//     weight / sum of the weights of all edges not drawn so far,
//
// and the two nodes that an edge joins become one. An edge whose ends have become one node is passed over;
// one that would make a node of more than most_bodies bodies is refused, and as nodes only grow it would be
// for ever after. So every edge that is contracted is drawn with probability proportional to weight among
// those that may be.
//
// Draws are of integers below the sum of the weights, in a tree of partial sums (Fenwick, A new data
// structure for cumulative frequency tables, 1994): exact on every machine, O(log edges) each.
#pragma once

#include <span>
#include <vector>

#include "harness/base/dice.h"
#include "partition/body_graph.h"

namespace cleave {

struct WeightedEdge {
  int a, b;  // a < b
  int weight;
};

// Ascending by a, then by b.
std::vector<WeightedEdge> edges_of(const BodyGraph& graph, EdgeWeight unit);

struct ContractionGoal {
  int nodes;        // no fewer are left
  int most_bodies;  // of a node
};

struct Contraction {
  std::vector<int> node_of_body;  // (n), numbered by their lowest body
  int node_count = 0;
  int refused = 0;  // edges drawn whose contraction would have passed most_bodies
};

// Contracts n single bodies until goal.nodes nodes are left or no edge. The weights add up to an int at most.
Contraction contract(int bodies, std::span<const WeightedEdge> edges, const ContractionGoal& goal,
                     Dice& dice);

}  // namespace cleave
