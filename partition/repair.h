// A partition taken over from an earlier graph of the same bodies and repaired where the graph changed, in
// place of a new one.
//
// 1. Parts keep their order; ids are closed up over those that have no body left.
// 2. Bodies without a part, in ascending order, join the adjacent part into which their edges weigh most in
//    rows, among those of fewer than most_bodies bodies, ties to the lowest id. A body that finds none
//    becomes a part of its own, the last.
// 3. Moves as fm makes them (Fiduccia and Mattheyses 1982; move_search.h), of bodies that may move alone: the
//    best move that lowers the cut in rows, into a part of fewer than most_bodies bodies, out of one of two
//    or more, until there is none.
//
// So no part grows above most_bodies, none is empty, and the moves leave no more rows cut than there were. A
// part that was in one piece need not stay so: an edge within it may be gone.
#pragma once

#include <span>
#include <vector>

#include "partition/body_graph.h"
#include "partition/partition.h"

namespace cleave {

// Step 1. part_of_body: (n) any numbers from 0, or -1, which stays.
Partition closed_up(std::span<const int> part_of_body);

// Steps 1 and 2. part_of_body: (n) ids of the earlier partition, any numbers from 0, or -1 for a body without
// a part. most_bodies >= 1. Throws std::invalid_argument where part_of_body has not one entry a body.
Partition take_over(const BodyGraph& graph, std::span<const int> part_of_body, int most_bodies);

// Step 3. may_move: (n).
void move_changed(const BodyGraph& graph, std::span<const char> may_move, int most_bodies,
                  Partition& partition);

// (n of `now`) 1 for bodies with another set of adjacent bodies than `before` had for the body of this index;
// bodies that only one of both has are told by their neighbours, and are changed themselves.
std::vector<char> changed_bodies(const BodyGraph& before, const BodyGraph& now);

}  // namespace cleave
