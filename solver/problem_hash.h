// Fingerprints of a step problem and of its solutions (harness/base/hash.h).
#pragma once

#include <cstdint>
#include <span>

#include "solver/step_problem.h"

namespace cleave {

// h_s, then all arrays in the order in which StepProblem declares them, without lengths: what is empty
// changes nothing.
std::uint64_t problem_hash(const StepProblem& problem);

// The impulses (m), then the part ids (n; none for a solver that ignores parts).
std::uint64_t solution_hash(std::span<const double> impulse, std::span<const int> part_of_body);

}  // namespace cleave
