// The residual of each row, axis of a turned box, or contact with a cone, for the judge (residual.h has the
// equations) alone.
#pragma once

#include <span>
#include <vector>

#include "solver/residual_bodies.h"
#include "solver/step_problem.h"

namespace cleave::judging {

// (m), 0 on rows that are not asked for. asked: (m) 1 where a row is, the normal row of a contact without a
// box for all of its rows; empty: all.
template <class Real>
std::vector<double> find_residuals(const StepProblem& problem, const BodyStates<Real>& bodies,
                                   std::span<const double> impulse, std::span<const char> asked = {});

}  // namespace cleave::judging
