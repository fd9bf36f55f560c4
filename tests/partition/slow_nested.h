// The recursion of nested.h and leftovers.h once more, straight from their definitions: sets are lists of
// bodies, and the graph of a set is built anew from the links among them.
#pragma once

#include "partition/nested.h"
#include "tests/partition/slow_twins.h"
#include "tests/partition/test_graphs.h"

namespace cleave::partition_test {

struct SlowNested {
  Partition nested;
  int joined = 0;  // parts that were left over and joined, in all sets
};

SlowNested slow_nested(const Bodies& bodies, const PartitionerTwin& partitioner,
                       const PartitionOptions& grown, const RefinerTwin& refiner,
                       const RefineOptions& refined, int arity);

}  // namespace cleave::partition_test
