// Slow, obvious versions of the partitioners and refiners, written straight from their definitions: at every
// step all candidates are scanned and every number is computed anew. The fast versions must give identical
// partitions. Of partition/ only the plain data headers are included, so that no code is shared with what is
// checked.
#pragma once

#include <span>

#include "partition/body_graph.h"
#include "partition/partition.h"
#include "tests/partition/paper_options.h"

namespace cleave::partition_test {

struct PartitionerTwin {
  const char* name;
  Partition (*run)(const BodyGraph& graph, const PartitionOptions& options);
};

struct RefinerTwin {
  const char* name;
  RefineSummary (*run)(const BodyGraph& graph, const RefineOptions& options, Partition& partition);
};

// mindp, maxdp, bfs, mr, mix.
std::span<const PartitionerTwin> partitioner_twins();

// none, kl, fm, and those that climb hills (slow_hill.h).
std::span<const RefinerTwin> refiner_twins();

}  // namespace cleave::partition_test
