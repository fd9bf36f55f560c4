// Fewer parts, body by body: the smallest are taken apart and their bodies go to the parts around them.
//
// While there are more than `parts` parts, the smallest (then of lowest id) is taken apart: the body of it
// goes into an adjacent part of fewer than most_bodies bodies that has the greatest gain in rows (D_i(B),
// gains.h), ties to the lowest body, then to the lowest part, again and again. Where no body of it touches
// such a part, its lowest body goes into the part of fewest bodies, then of lowest id. In the end ids are
// closed up. So there are exactly `parts` parts where there were more; they need not be contiguous, and what
// was taken apart is mostly cut worse than before: moves of single bodies should follow.
//
// O(n log n log(parts before / parts)) for bodies of bounded degree.
#pragma once

#include "partition/body_graph.h"
#include "partition/partition.h"

namespace cleave {

// No part has more than most_bodies bodies before, and none has after. parts * most_bodies >= n. Returns
// how many gains it worked out.
long dissolve_smallest(const BodyGraph& graph, int parts, int most_bodies, Partition& partition);

}  // namespace cleave
