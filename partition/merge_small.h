// Mending of grown parts: growing leaves parts of one or a few bodies that earlier parts have cut off, and
// ragged ones where it went around them. With merge-small there are as many parts as are wanted, and bodies
// move between all of them.
//
// With k = ceil(n / max-bodies) and B = floor(1.2 max-bodies + 1e-9), as grown parts come:
//
// 1. Crumbs are joined. While there are more than k parts, the smallest of fewer than max-bodies / 2 bodies
//    is joined with the adjacent part to which its edges weigh most in rows, among those with which it has at
//    most B bodies (leftovers.h).
// 2. The smallest of the others are dissolved body by body, until k are left (dissolve.h).
// 3. Bodies move between adjacent parts while that lowers the cut in rows, over hills too (local_climbs.h).
//
// Where the k parts in the end cut more rows than those of step 1, there is no step 2. So parts have at most
// B bodies, they cut no more rows than crumbs joined alone would leave, and there are k of them unless more
// cut fewer rows. They need not be contiguous. All takes about O(n log n) (their headers say how much).
#pragma once

#include <memory>

#include "partition/partitioner.h"

namespace cleave {

// B. It is as much as the refiner fm lets a part have, unless it is told otherwise.
int most_merged_bodies(int max_bodies);

// Steps 1 to 3 on parts of at most max_bodies bodies. Returns how many gains steps 2 and 3 worked out.
long mend(const BodyGraph& graph, int max_bodies, Partition& partition);

// `grown` and then this. max_bodies: its parameter.
std::unique_ptr<Partitioner> merge_small(std::unique_ptr<Partitioner> grown, int max_bodies);

}  // namespace cleave
