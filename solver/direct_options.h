// What solvers are told: the options of every direct one (strategy:kernel), and the parameters that strategies, kernels and
// baselines declare in the registry.
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

namespace parameters {

const Parameter& max_iterations();
const Parameter& predictor_sweeps();
const Parameter& reuse_analysis();
const Parameter& sweeps();
const Parameter& until();
const Parameter& order();
const Parameter& order_seed();
const Parameter& coloring();
const Parameter& coloring_seed();
const Parameter& lemke_max_rows();
const Parameter& arity();

}  // namespace parameters
}  // namespace cleave
