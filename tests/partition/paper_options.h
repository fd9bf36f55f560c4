// The parameters of the paper's partitioners and refiners as one struct each, so that tests can draw and
// change them, and how a registry row is made from them.
#pragma once

#include <memory>

#include "partition/parameters.h"
#include "partition/registry.h"

namespace cleave::partition_test {

struct PartitionOptions {
  int max_bodies = 25;
  double tau_mr = 10.0;
  double tau_mix = 0.5;
  EdgeWeight edge_weight = EdgeWeight::rows;
  DegreeUnit degree = DegreeUnit::bodies;
  DegreeScope degree_scope = DegreeScope::left;
  bool as_printed = false;
  int trials = 3;  // enough to choose from
};

struct RefineOptions {
  int max_bodies = 25;
  double max_growth = 0.2;
  EdgeWeight edge_weight = EdgeWeight::rows;
  bool as_printed = false;
};

// Complete settings of a row; what the options do not speak of keeps its default.
Algorithm algorithm_of(const AlgorithmEntry& entry, const PartitionOptions& options);
Algorithm algorithm_of(const AlgorithmEntry& entry, const RefineOptions& options);

// As the row sees them: options that it does not have are at their defaults.
RefineOptions options_of(const AlgorithmEntry& entry, const RefineOptions& options);

Partition run(const PartitionerEntry& entry, const BodyGraph& graph, const PartitionOptions& options);
RefineSummary run(const RefinerEntry& entry, const BodyGraph& graph, const RefineOptions& options,
                  Partition& partition);

}  // namespace cleave::partition_test
