// What direct solvers (strategy:kernel) are told beside the options of every solver.
#pragma once

#include "harness/base/parameter.h"
#include "solver/step_solver.h"

namespace cleave {

struct DirectOptions : SolveOptions {
  int max_iterations;    // of every strategy that runs; a miss is a status, not a result
  int predictor_sweeps;  // Gauss-Seidel sweeps that pivot starts from
  bool reuse_analysis;   // keep the symbolic analysis while parts stay and rows fit its pattern
};

// Parameters that the settings do not have take their defaults.
DirectOptions read_direct_options(const SolveOptions& options, const Settings& settings = {});

}  // namespace cleave
