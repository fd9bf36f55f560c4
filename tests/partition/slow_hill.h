// Slow twins of the refiners that climb hills (slow_twins.h), and of one climb (hill_climb.h).
#pragma once

#include <set>

#include "partition/body_graph.h"
#include "partition/partition.h"
#include "tests/partition/paper_options.h"

namespace cleave::partition_test {

struct SlowClimb {
  const BodyGraph& graph;
  EdgeWeight unit;
  int most_bodies;  // of a part
  int patience;

  // known: bodies whose moves count at the beginning; those next to what has moved follow. Returns the bodies
  // whose moves were kept.
  std::set<int> run(std::set<int> known, std::set<int> locked, Partition& partition) const;
};

RefineSummary slow_fm_hill(const BodyGraph& graph, const RefineOptions& options, Partition& partition);
RefineSummary slow_kl_hill(const BodyGraph& graph, const RefineOptions& options, Partition& partition);

}  // namespace cleave::partition_test
