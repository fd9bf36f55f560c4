// Orders of elimination that keep the fill of a sparse symmetric matrix small, on the graph of its blocks.
#pragma once

#include <span>

namespace cleave {

// By node, both directions, ascending: neighbours of node i are adjacency[first[i]] .. adjacency[first[i + 1]
// - 1]. An adjacency without entries still has an address.
struct BlockGraph {
  std::span<const int> first, adjacency;
  int node_count() const { return static_cast<int>(first.size()) - 1; }
};

// Approximate minimum degree (Amestoy, Davis, Duff 1996; CAMD). constraint: (n) or empty; nodes of a lower
// one come before those of a higher one, all are below n. Writes the node at every position. Throws
// std::bad_alloc.
void order_by_degree(const BlockGraph& graph, std::span<const int> constraint,
                     std::span<int> node_at_position);

// Nested dissection (George 1973; Karypis and Kumar 1998; METIS): much slower, and worth it where a pile is
// as high as it is wide. It resets the sequence of the C library's rand(), which it draws from: a program
// that calls rand() on another thread meanwhile gets another order. False, and nothing is written, in a build
// without METIS. Throws std::bad_alloc.
[[nodiscard]] bool order_by_dissection(const BlockGraph& graph, std::span<int> node_at_position);

}  // namespace cleave
