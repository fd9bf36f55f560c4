// What `cleave calibrate` times: recorded problems, or steps of shipped scenes that it simulates itself.
#pragma once

#include <string>
#include <vector>

#include "solver/step_problem.h"

namespace cleave {

struct CalibrationProblem {
  std::string source;  // a file, or a scene with its options: held out as a whole
  StepProblem problem;
  std::vector<double> position_m;  // (n, 3), or empty
};

// Throws as read_problem_file.
std::vector<CalibrationProblem> recorded_problems(const std::vector<std::string>& files);

// Piles, towers, chains and silos of several sizes, several steps of each; a minute or so. seed: of the
// scenes.
std::vector<CalibrationProblem> simulated_problems(std::uint64_t seed);

}  // namespace cleave
