// What run and record share: a simulation into an output directory.
#pragma once

#include <string>
#include <vector>

#include "harness/options.h"
#include "harness/simulation.h"

namespace cleave {

// Makes everything that can be refused, then creates the directory, simulates into its steps.csv and
// manifest.json, and returns the exit code.
int simulate(const std::string& command, const std::vector<std::string>& argv, const RunOptions& options,
             Simulation::Observer observe = {});

}  // namespace cleave
