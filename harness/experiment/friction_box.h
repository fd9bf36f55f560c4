// The friction model `box`: bounds from predicted normal impulses, frozen before the solve.
#pragma once

#include <span>

#include "harness/world/extract.h"
#include "solver/step_problem.h"

namespace cleave {

// Starts from warm_impulse, runs so many projected Gauss-Seidel sweeps in row order, in which a friction row
// is clamped to +-mu times the present impulse of its normal row, and freezes the bounds at +-mu times the
// resulting normal impulses. The impulses themselves are thrown away. O(rows) time a sweep.
void predict_friction_bounds(StepProblem& problem, int sweeps = kBoundSweeps);

// mu times the normal impulse of a friction row's contact; lambda_n below zero counts as zero. impulse: (m).
double coulomb_bound(const StepProblem& problem, int row, std::span<const double> impulse);

// Freezes the bounds at +-mu times these normal impulses.
void set_coulomb_bounds(std::span<const double> impulse, StepProblem& problem);

}  // namespace cleave
