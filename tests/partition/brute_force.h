// Partition numbers counted from the raw links, never through BodyGraph, and checks that say what is wrong.
#pragma once

#include <string>
#include <vector>

#include "partition/partition.h"
#include "tests/partition/paper_options.h"
#include "tests/partition/test_graphs.h"

namespace cleave::partition_test {

// [body][other]: the links between two different bodies, added up in the given unit (pairs: 0 or 1).
using WeightMatrix = std::vector<std::vector<long>>;
WeightMatrix link_weights(const Bodies& bodies, EdgeWeight unit);

long counted_cut(const Bodies& bodies, const std::vector<int>& part_of_body, EdgeWeight unit);

PartitionMetrics metrics_by_counting(const Bodies& bodies, const std::vector<int>& part_of_body);

// One island id per body, numbered by their lowest body; by union-find over the links.
std::vector<int> islands_by_union_find(const Bodies& bodies);

// The checks below return "" when all is well, else one line.

// Every body in exactly one part, ids 0 .. part_count-1, no part empty.
std::string ids_fault(const Bodies& bodies, const Partition& partition);

// ids_fault; every part connected and of at most max_bodies bodies.
std::string grown_fault(const Bodies& bodies, const Partition& partition, int max_bodies);

// ids_fault; parts as many as before; no part grown over floor((1 + max_growth) max_bodies) unless
// as_printed; the cut in the unit of the options counted right before and after, and not increased unless it
// may be.
std::string refined_fault(const Bodies& bodies, const Partition& before, const Partition& after,
                          const RefineOptions& options, const RefineSummary& summary,
                          bool may_raise_cut = false);

}  // namespace cleave::partition_test
