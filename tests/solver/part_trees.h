// Trees of parts (solver/parts.h) for tests, without a partitioner.
#pragma once

#include <vector>

#include "solver/parts.h"
#include "tests/solver/seeded_random.h"

namespace cleave {

struct PartTree {
  std::vector<int> part_of_body, parent_of_part;
  Parts parts() const { return {part_of_body, parent_of_part}; }
};

// Slices of bodies, joined in pairs until one node is left.
PartTree sliced_tree(int bodies, int leaves);

// Bodies are dealt out at random among some of the leaves, and the others have none. Nodes drawn at random,
// two to five at a time, are joined until one is left, so that leaves lie at all depths.
PartTree random_tree(SeededRandom& random, int bodies, int leaves);

}  // namespace cleave
