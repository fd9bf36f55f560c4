// Crumbs: growing leaves parts of one or a few bodies that earlier parts have cut off. With merge-small they are folded into
// parts that they touch.
//
// While there are more than k = ceil(n / max-bodies) parts, the smallest of fewer than max-bodies / 2 bodies is joined with the
// adjacent part to which its edges weigh most in rows, among those with which it has at most B = floor(1.2 max-bodies + 1e-9)
// bodies; one that fits with none stays (leftovers.h). So parts are contiguous where those of the partitioner are, and have
// at most max(B, the largest as grown) bodies.
#pragma once

#include <memory>

#include "partition/partitioner.h"

namespace cleave {

// B. It is as much as the refiner fm lets a part have, unless it is told otherwise.
int most_merged_bodies(int max_bodies);

// `grown` and then this. max_bodies: its parameter.
std::unique_ptr<Partitioner> merge_small(std::unique_ptr<Partitioner> grown, int max_bodies);

}  // namespace cleave
