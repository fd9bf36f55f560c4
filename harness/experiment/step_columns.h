// The columns of a row that do not depend on the combination: those of the run and those of the problem.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "harness/experiment/options.h"
#include "harness/experiment/step_record.h"
#include "harness/world/ode_world.h"
#include "solver/step_problem.h"

namespace cleave {

// Options that say how problems are split and solved; the rest of the row unmeasured.
StepRecord solve_columns(const RunOptions& options);

// All options that are columns; the rest of the row unmeasured.
StepRecord run_columns(const RunOptions& options);

// "name=value" of each parameter of a scene that is no path, sorted, with ";" between.
std::string scene_options_cell(const std::vector<Parameter>& parameters,
                               const std::function<std::string(const std::string& name)>& value_of);

// Sizes, islands and fingerprint of a step's problem, from its arrays alone.
void set_problem_columns(const StepProblem& problem, StepRecord& row);

// Depth of the deepest contact; 0 without contacts.
double deepest_m(std::span<const ContactPoint> contacts);

}  // namespace cleave
