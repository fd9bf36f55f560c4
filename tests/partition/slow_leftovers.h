// Joining of leftovers (leftovers.h) once more, straight from its definition: everything is counted anew for
// every pair.
#pragma once

#include "partition/leftovers.h"
#include "tests/partition/test_graphs.h"

namespace cleave::partition_test {

// Returns how many were joined.
int slow_join_leftovers(const Bodies& bodies, const LeftoverBounds& bounds, Partition& parts);

}  // namespace cleave::partition_test
