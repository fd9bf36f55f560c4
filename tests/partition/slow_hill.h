// Slow twins of the refiners that climb hills (slow_twins.h).
#pragma once

#include "partition/body_graph.h"
#include "partition/partition.h"
#include "tests/partition/paper_options.h"

namespace cleave::partition_test {

RefineSummary slow_fm_hill(const BodyGraph& graph, const RefineOptions& options, Partition& partition);
RefineSummary slow_kl_hill(const BodyGraph& graph, const RefineOptions& options, Partition& partition);

}  // namespace cleave::partition_test
