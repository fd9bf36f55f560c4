// From a step problem to the parts of one (partitioner, refiner): graph, growing, refining, each with its
// time.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "harness/options.h"
#include "partition/body_graph.h"
#include "partition/partition.h"
#include "solver/step_problem.h"

namespace cleave {

struct Split {
  BodyGraph graph;
  Partition before;  // as grown
  Partition parts;   // as refined
  double graph_ms = 0, partition_ms = 0, refine_ms = 0;
};

class Splitter {
 public:
  // Throws std::invalid_argument with the name when a table does not have it.
  Splitter(std::string_view partitioner, std::string_view refiner, const RunOptions& options);

  Split run(const StepProblem& problem) const;

 private:
  Partition grow(const BodyGraph& graph) const;

  std::unique_ptr<Partitioner> partitioner_;
  std::unique_ptr<Refiner> refiner_;
  PartitionOptions partition_options_;
  RefineOptions refine_options_;
  bool skip_small_islands_;
};

// --skip-small-islands: the bodies of islands larger than options.max_bodies are partitioned as if the small
// islands were not there; then every small island becomes one part, in order of its lowest body.
Partition partition_large_islands(const BodyGraph& graph, const Partitioner& partitioner,
                                  const PartitionOptions& options);

}  // namespace cleave
