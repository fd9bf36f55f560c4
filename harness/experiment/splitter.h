// From a step problem to the parts of one (partitioner, refiner): graph, growing, refining, each with its
// time. For a solver that takes a tree of parts, by recursion.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/base/algorithm.h"
#include "harness/experiment/body_order.h"
#include "harness/experiment/problem_graph.h"
#include "partition/body_graph.h"
#include "partition/nested.h"
#include "partition/partition.h"
#include "partition/partitioner.h"
#include "partition/refiner.h"
#include "solver/step_problem.h"

namespace cleave {

// Where the parts of a step come from: made for it, repaired or unchanged from those of the step before.
enum class PartitionOrigin { fresh, repaired, kept };
std::string to_string(PartitionOrigin origin);
std::optional<PartitionOrigin> find_origin(const std::string& text);

struct Split {
  BodyGraph graph;
  Partition before;  // as grown; by recursion, what it gives without refinement; repaired, before the moves
  Partition parts;   // as refined
  // By recursion sums over all sets; whatever is not refining counts as partitioning.
  double graph_ms = 0, partition_ms = 0, refine_ms = 0;
  PartitionOrigin origin = PartitionOrigin::fresh;
};

// How bodies are split.
struct SplitSetup {
  Algorithm partitioner, refiner;
  bool skip_small_islands = false;
  // Children of a set, by recursion; none: one level, as parts of a partitioner without max-bodies are (file,
  // single), or the tree that it makes itself (auto).
  std::optional<int> arity = {};
  BodyOrder order = {};     // numbers by which they are split
  std::string choice = {};  // that a partitioner made before and is to make again; empty: it chooses
};

// What a solver says of it: its parameter `arity`, where it has one.
std::optional<int> arity_of(const Algorithm& solver);

class Splitter {
 public:
  // Throws std::invalid_argument for --skip-small-islands with a partitioner that has no max-bodies, for a
  // choice that the partitioner does not make, and for another order than the scene's with parts that come
  // from files.
  explicit Splitter(const SplitSetup& setup);

  // step: which one of its run the problem is. Throws CannotSplit where the partitioner does.
  Split run(const StepProblem& problem, std::optional<int> step = std::nullopt,
            const KnownBodies& known = {}) const;

  // The same of a graph that is there already.
  void run(Split& split) const;

  // max-bodies of the partitioner, or the size of the largest part where it has none.
  int most_bodies(const Partition& grown) const;

 private:
  void run_by_numbers(Split& split) const;
  void run_once(Split& split) const;
  void run_recursion(Split& split) const;
  Partition nest(const BodyGraph& graph, bool refines, double& refine_ms) const;
  Partition grow(const BodyGraph& graph) const;

  std::unique_ptr<Partitioner> partitioner_;
  std::unique_ptr<Refiner> refiner_;
  std::optional<SetSplitter> set_splitter_;  // where bodies are split by recursion
  bool skip_small_islands_;
  BodyOrder order_;
};

}  // namespace cleave
