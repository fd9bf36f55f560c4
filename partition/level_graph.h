// A graph of a multilevel scheme (Hendrickson and Leland 1995; Karypis and Kumar 1998): a node stands for one
// body or for several that were joined, an edge for all constraints between two nodes.
//
// Compressed rows as in body_graph.h, but the neighbours of a node come in any order. Objects are made to be
// filled again: their memory is kept.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "partition/body_graph.h"

namespace cleave {

struct LevelGraph {
  std::vector<int> bodies;     // (nodes) how many each stands for
  std::vector<int> first{0};   // (nodes + 1)
  std::vector<int> neighbour;  // (2 edges)
  std::vector<int> weight;     // (2 edges)

  int node_count() const { return static_cast<int>(bodies.size()); }
  int body_count() const;
  std::span<const int> neighbours(int node) const {
    return std::span(neighbour).subspan(first[node], first[node + 1] - first[node]);
  }

  // One node a body.
  void take(const BodyGraph& graph, EdgeWeight unit);

  // The nodes of either side with the edges among them: node k of half s is nodes[s][k] here, ascending.
  // side: (nodes) 0 or 1. place: scratch.
  void split(std::span<const char> side, std::array<LevelGraph, 2>& halves,
             std::array<std::vector<int>, 2>& nodes, std::vector<int>& place) const;

  void resize(int nodes, std::size_t half_edges);
};

// What the coarse nodes have, of_node (coarse nodes), becomes what the nodes have that were joined to them.
template <class T>
void give_to_finer(std::span<const int> coarse_of_node, std::vector<T>& of_node, std::vector<T>& scratch) {
  scratch.resize(coarse_of_node.size());
  for (std::size_t node = 0; node < scratch.size(); ++node) scratch[node] = of_node[coarse_of_node[node]];
  of_node.swap(scratch);
}

// Joins nodes of a graph; keeps its memory.
class Coarsening {
 public:
  // Heavy-edge matching (Karypis and Kumar 1998, section 3.1): each node in turn, thinly connected ones first
  // and among equals from node `begin` on, around to the one before it, is joined with
  // the free neighbour of heaviest edge, ties to the one of fewer bodies, then to the lowest, if both have at
  // most most_bodies together. Fills coarse_of_node (nodes), numbered by the lowest node of each pair;
  // returns how many there are.
  int match(const LevelGraph& graph, int most_bodies, int begin, std::vector<int>& coarse_of_node);

  // The graph of nodes joined by pairs, as match() numbers them.
  void contract(const LevelGraph& graph, std::span<const int> coarse_of_node, int coarse_nodes,
                LevelGraph& coarse);

 private:
  std::vector<int> degree_first_, order_, mate_;  // of match()
  std::vector<std::array<int, 2>> pair_;          // of nodes, by coarse node; -1 for none
  std::vector<int> slot_;                         // by coarse node
};

}  // namespace cleave
