// The steps of merge-small (merge_small.h) once more, straight from their definitions: everything is counted
// anew at every step.
#pragma once

#include "partition/local_climbs.h"
#include "tests/partition/test_graphs.h"

namespace cleave::partition_test {

// dissolve.h; returns how many parts were taken apart.
int slow_dissolve_smallest(const Bodies& bodies, int parts, int most_bodies, Partition& partition);

// local_climbs.h; returns how many moves were kept.
int slow_climb_locally(const Bodies& bodies, const LocalClimbs& options, Partition& partition);

Partition slow_mend(const Bodies& bodies, int max_bodies, const Partition& grown);

}  // namespace cleave::partition_test
