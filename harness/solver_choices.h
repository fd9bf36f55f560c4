// The solvers a run can name: those of solver/ and ODE's own, which need a world.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "harness/options.h"
#include "solver/registry.h"
#include "solver/step_solver.h"

namespace cleave {

// What `cleave list solvers` shows: the short names of solver/registry.h, then ode_baselines().
std::vector<SolverEntry> solver_entries();

// Every name of --solver: all_solver_names(), then ode_baselines().
std::vector<std::string> solver_choices();

// Throws std::invalid_argument for an unknown name, as make_step_solver does.
std::unique_ptr<StepSolver> make_solver(const std::string& name, const RunOptions& options);

}  // namespace cleave
