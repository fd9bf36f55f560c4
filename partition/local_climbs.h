// Moves of single bodies between all parts that lower the cut in rows, found from one place after another:
// localized k-way search with hill-climbing (multi-try FM; Sanders and Schulz, Engineering Multilevel Graph
// Partitioning Algorithms, ESA 2011).
//
// Rounds follow each other, at most most_rounds, until one has nothing to look at. In a round every body it
// looks at, in ascending order, is where a climb (hill_climb.h) begins: with the moves of this body alone,
// then also with those of the bodies next to what has moved. A body whose move was kept stays where it is for
// the rest of the round; one whose move was taken back is free again at once. The first round looks at all
// bodies, a later one at those that moved in the round before and those next to them.
//
// No part grows above most_bodies, none becomes empty, and the cut never rises. A climb that begins at one
// body sees no more than what is around it, so a round is at most n (patience + 1) moves, whatever the number
// of parts; one that begins with all bodies, as in fm-hill, ends for good where the last `patience` best
// moves of the whole graph brought nothing.
#pragma once

#include "partition/body_graph.h"
#include "partition/partition.h"

namespace cleave {

struct LocalClimbs {
  int most_bodies;  // of a part
  int patience;     // of a climb
  int most_rounds;
};

// Returns how many gains it worked out.
long climb_locally(const BodyGraph& graph, const LocalClimbs& options, Partition& partition);

}  // namespace cleave
