// From a step problem to the parts of one (partitioner, refiner): graph, growing, refining, each with its
// time.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "harness/base/algorithm.h"
#include "partition/body_graph.h"
#include "partition/partition.h"
#include "partition/partitioner.h"
#include "partition/refiner.h"
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
  // Throws std::invalid_argument for --skip-small-islands with a partitioner that has no max-bodies.
  Splitter(const Algorithm& partitioner, const Algorithm& refiner, bool skip_small_islands);

  // step: which one of its run the problem is. Throws CannotSplit where the partitioner does.
  Split run(const StepProblem& problem, std::optional<int> step = std::nullopt) const;

 private:
  Partition grow(const BodyGraph& graph) const;
  int most_bodies(const Partition& grown) const;

  std::unique_ptr<Partitioner> partitioner_;
  std::unique_ptr<Refiner> refiner_;
  bool skip_small_islands_;
};

// --skip-small-islands: the bodies of islands larger than max_bodies are partitioned as if the small
// islands were not there; then every small island becomes one part, in order of its lowest body.
Partition partition_large_islands(const BodyGraph& graph, const Partitioner& partitioner, int max_bodies);

}  // namespace cleave
