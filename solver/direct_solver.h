// A solver made of a strategy and a kernel, with the chain of strategies that take over when one gives up.
#pragma once

#include <memory>
#include <string_view>

#include "harness/base/parameter.h"
#include "solver/step_solver.h"

namespace cleave {

// strategy and kernel are names of registry.h; nullptr when the pair does not exist. settings: values of the
// parameters that strategy and kernel declare.
std::unique_ptr<StepSolver> make_direct_solver(std::string_view strategy, std::string_view kernel,
                                               const SolveOptions& options, const Settings& settings);

}  // namespace cleave
