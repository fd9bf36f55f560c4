// The body graph of a step problem, from its arrays alone, so that it is the same for a live and for a
// replayed step.
#pragma once

#include "partition/body_graph.h"
#include "solver/step_problem.h"

namespace cleave {

// One link per constraint (a joint or one contact point: adjacent rows of equal row_constraint), with its
// number of rows. A body's mass is the first diagonal entry of its mass block.
BodyGraph body_graph_of(const StepProblem& problem);

}  // namespace cleave
