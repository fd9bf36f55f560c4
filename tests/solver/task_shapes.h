// How a problem falls into tasks, for tests that are about a problem with many.
#pragma once

#include "solver/parts.h"
#include "solver/step_problem.h"

namespace cleave {

// Of the predictor (solver/slabs.h).
int count_slabs(const StepProblem& problem);

// Whether a kernel that factors along an elimination tree has a front in tiles (solver/factor_tasks.h), with
// these parts at their levels.
bool has_tiled_front(const StepProblem& problem, const Parts& parts);

}  // namespace cleave
