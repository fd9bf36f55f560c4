// The assertions that every solver test uses. They trust the judge and nothing that a solver says of itself.
#pragma once

#include <gtest/gtest.h>

#include <span>
#include <string_view>

#include "solver/residual.h"
#include "solver/solution.h"
#include "solver/step_problem.h"
#include "solver/step_solver.h"

namespace cleave {

// Status ok, residual within the limit, and the velocity is the one that the impulses give (1e-9, scaled).
testing::AssertionResult is_exact(const StepProblem& problem, const SolveSummary& summary,
                                  const Solution& solution);

// Status ok if and only if the residual is within the limit (between half the limit and the limit a solver
// may doubt itself), and a message where it is not ok.
testing::AssertionResult is_honest(const StepProblem& problem, const SolveSummary& summary,
                                   const Solution& solution);

// Largest difference of two velocity vectors <= tolerance * max(1, largest |v0|, largest |expected|).
testing::AssertionResult velocities_agree(const StepProblem& problem, std::span<const double> actual,
                                          std::span<const double> expected, double tolerance);

// Same bits, NaN and signed zeros included.
bool same_bytes(std::span<const double> a, std::span<const double> b);

// Iterative solvers and those known to cycle may end with not_converged; all others must be exact.
bool may_miss(std::string_view solver);
// The part of a solver name behind the colon ("" for a short name other than dense, monolithic, schur).
std::string kernel_of(std::string_view solver);

Solution cold_start(const StepProblem& problem);

}  // namespace cleave
