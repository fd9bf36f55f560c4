// A solver made of a strategy and a kernel, with the chain of strategies that take over when one gives up.
#pragma once

#include <memory>
#include <string_view>

#include "harness/base/parameter.h"
#include "solver/step_solver.h"
#include "solver/strategies/strategy.h"

namespace cleave {

// strategy and kernel are names of registry.h; nullptr when the pair does not exist. settings: values of the
// parameters that strategy and kernel declare. own, where given, runs in place of the registry's strategy of
// that name.
std::unique_ptr<StepSolver> make_direct_solver(std::string_view strategy, std::string_view kernel,
                                               const SolveOptions& options, const Settings& settings,
                                               std::unique_ptr<Strategy> own = nullptr);

}  // namespace cleave
