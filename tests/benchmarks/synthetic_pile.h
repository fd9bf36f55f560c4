// Graphs like those of settled piles, of any size, for benchmarks of partitioners.
#pragma once

#include <cstdint>
#include <span>

#include "partition/body_graph.h"

namespace cleave {

// Bodies layer by layer on a grid in a square pit, each moved at random by up to 0.3 grid lengths along every
// axis. Of the pairs in neighbouring cells the 1.765 n closest touch (353 edges for 200 bodies, as in a
// settled pile of boxes), each at 1 to 8 points of 3 rows. Masses are drawn from mass_kg. The graph has
// positions, in grid lengths.
BodyGraph synthetic_pile(int bodies, std::span<const double> mass_kg, std::uint64_t seed);

}  // namespace cleave
