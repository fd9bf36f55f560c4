// The parts of one combination over consecutive steps (--repartition).
//
// A step is split anew (fresh) where there is no step before or its parts were never found, where bodies are
// gone (nobody knows which), or where the rule of the option says so:
//   always     in every step.
//   on-change  never for another reason.
//   every:K    K steps after the last time.
//   drift:X    where the parts as taken over cut more than (1 + X) s of the rows between bodies, s being the
//              share that the last fresh parts cut in their own step.
// Otherwise the parts of the step before are taken over: kept, to the byte, where there are as many bodies
// and the same pairs of them are adjacent, whatever their weights are now; else repaired
// (partition/repair.h). Bodies that may move are those with other adjacent bodies than before. No part gets
// more bodies than max-bodies and the largest of the last fresh parts. A tree of parts is not repaired but
// made anew.
//
// Every call to run starts from what was remembered last, so that a step can be repeated.
#pragma once

#include <optional>
#include <vector>

#include "harness/experiment/problem_graph.h"
#include "harness/experiment/repartition.h"
#include "harness/experiment/splitter.h"

namespace cleave {

class PartitionKeeper {
 public:
  explicit PartitionKeeper(const Repartition& rule) : rule_(rule) {}

  // Whether steps before may matter at all.
  bool keeps() const { return rule_.kind != Repartition::Kind::always; }

  // As Splitter::run. Times count what ran: taking over counts as partitioning, its moves as refining, and
  // where the outcome is thrown away for a fresh one, both count as partitioning.
  Split run(const Splitter& splitter, const StepProblem& problem, int step, const KnownBodies& known) const;

  // What run gave for the step at hand becomes the step before.
  void remember(const Splitter& splitter, const Split& split);
  void forget() { before_.reset(); }

 private:
  bool is_due(const BodyGraph& graph) const;
  void take_over_parts(Split& split) const;
  bool drifted(const Split& split) const;

  struct Before {
    BodyGraph graph;
    Partition parts;
    int steps_since_fresh = 0;
    int most_bodies = 1;   // of a part that is repaired
    double cut_share = 0;  // of the last fresh parts
  };

  Repartition rule_;
  std::optional<Before> before_;
};

}  // namespace cleave
