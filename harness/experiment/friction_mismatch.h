// How far frozen friction bounds leave a solution from Coulomb's law: columns of steps.csv.
#pragma once

#include <span>

#include "solver/step_problem.h"

namespace cleave {

// Over the friction rows whose box stands for mu times their contact's normal impulse n (n below zero counts
// as zero), with the bounds and impulses of one solution:
//
//     bound_mismatch          sum |bound - mu n| / sum mu n
//     friction_beyond_share   share of these rows whose |impulse| > mu n (1 + 1e-9)
//
// NaN where there is no such row (no friction, constant bounds, cones) and where their contacts carry nothing
// at all.
struct FrictionMismatch {
  double bound_mismatch, friction_beyond_share;
};

// impulse: (m)
FrictionMismatch friction_mismatch(const StepProblem& problem, std::span<const double> impulse);

}  // namespace cleave
