// Bodies that stand between parts: a small vertex cover of the cut edges, which a solver that cuts bodies
// eliminates last.
//
// Greedy: the body with the most uncovered cut edges first, the lowest index on ties.
#pragma once

#include <span>
#include <vector>

#include "partition/body_graph.h"

namespace cleave {

// (n) 1 for the bodies of the cover. part_of_body: (n), any ids.
std::vector<char> cut_cover(const BodyGraph& graph, std::span<const int> part_of_body);

// The node of a tree of parts (nested.h) that each body is eliminated with, (n): an edge is cut at the lowest
// node that has both of its parts below it. From the root down, a cover of the edges cut at a node that no
// cover above touches belongs to that node; all other bodies belong to their part. So no two nodes share an
// edge unless one is above the other, and their numbers are an order of elimination (George, SIAM Journal on
// Numerical Analysis 10, 1973). part_of_body: (n) ids 0 .. part_count - 1. parent_of_part: (nodes), or empty:
// one level, whose root is part_count.
std::vector<int> separator_nodes(const BodyGraph& graph, std::span<const int> part_of_body, int part_count,
                                 std::span<const int> parent_of_part);

}  // namespace cleave
