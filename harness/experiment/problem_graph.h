// The body graph of a step problem, from its arrays alone and what its file holds too, so that it is the same
// for a live and for a replayed step.
#pragma once

#include <optional>
#include <span>

#include "partition/body_graph.h"
#include "solver/step_problem.h"

namespace cleave {

// What is known of the bodies besides the problem; each empty where nobody knows.
struct KnownBodies {
  std::span<const double> position_m = {};  // (n, 3) centres
  std::span<const int> group = {};          // (n) as BodyGraph::set_groups wants it
};

// One link per constraint (a joint or one contact point: adjacent rows of equal row_constraint), with its
// number of rows. A body's mass is the first diagonal entry of its mass block. step: which one of its run the
// problem is.
BodyGraph body_graph_of(const StepProblem& problem, std::optional<int> step = std::nullopt,
                        const KnownBodies& known = {});

}  // namespace cleave
