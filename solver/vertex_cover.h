// A small set of bodies that touches every cut edge: the interface of the schur-bodies kernel.
//
// Each connected component of the cut graph is treated alone. Where it is bipartite (always between two
// parts) the cover is minimum, by Koenig's theorem: from a maximum matching, the left nodes not reachable
// from a free left node by alternating paths, and the right nodes that are. Elsewhere it is greedy: the body
// with most uncovered edges, lowest index on ties. Source: Koenig 1931; Schrijver, Combinatorial
// Optimization, section 16.2.
#pragma once

#include <span>
#include <utility>
#include <vector>

namespace cleave {

// edges: pairs of distinct nodes, duplicates allowed. Returns (node_count) 1 for nodes of the cover.
std::vector<char> vertex_cover(int node_count, std::span<const std::pair<int, int>> edges);

}  // namespace cleave
