// What the tests of iterative baselines share.
#pragma once

#include <string>
#include <vector>

#include "solver/solution.h"
#include "solver/step_problem.h"
#include "solver/step_solver.h"

namespace cleave {

struct Iterated {
  SolveSummary summary;
  Solution solution;
};

// From a cold start, the bodies in as many slices as there are parts.
Iterated iterate_by(const std::string& solver, const StepProblem& problem, int parts = 1, int threads = 1);

// f = 1/2 lambda^T (J M^-1 J^T + C) lambda + lambda^T (J v0 - b), J.
double energy_of(const StepProblem& problem, const std::vector<double>& impulse);

}  // namespace cleave
