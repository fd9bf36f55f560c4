// What growing leaves over: small parts that earlier ones have cut off from the rest. Each is joined with a
// part that it touches, so that a set split by recursion has about as many children as it was to have.
//
// While there are more than `parts` parts, the smallest part (then of lowest id) of fewer than `small_bodies`
// bodies is joined with the adjacent part to which its edges weigh most in rows (then of lowest id), among
// those with which it has at most `most_bodies` bodies; a part that fits with none stays. Joined parts have
// the lower of both ids, and in the end ids are closed up.
#pragma once

#include "partition/body_graph.h"
#include "partition/partition.h"

namespace cleave {

struct LeftoverBounds {
  int parts;
  int small_bodies;
  int most_bodies;
};

void join_leftovers(const BodyGraph& graph, const LeftoverBounds& bounds, Partition& partition);

}  // namespace cleave
