// What run and record share: a simulation into an output directory.
#pragma once

#include <string>
#include <vector>

#include "harness/experiment/options.h"
#include "harness/experiment/simulation.h"

namespace cleave {

// observe: not beside --record-motion, which observes itself. Makes everything that can be refused, then
// creates the directory, simulates into its steps.csv and manifest.json, and returns the exit code.
int simulate(const std::string& command, const std::vector<std::string>& argv, const RunOptions& options,
             Simulation::Observer observe = {});

}  // namespace cleave
