// What run and record share: a simulation into an output directory.
#pragma once

#include <string>
#include <vector>

#include "harness/experiment/options.h"
#include "harness/experiment/simulation.h"

namespace cleave {

// files: that the command writes into --out. observe: not beside --record-motion, which observes itself.
// Checks the directory, makes everything that can be refused, then simulates into it and returns the exit
// code.
int simulate(const std::string& command, const std::vector<std::string>& argv, const RunOptions& options,
             const std::vector<std::string>& files, Simulation::Observer observe = {});

}  // namespace cleave
