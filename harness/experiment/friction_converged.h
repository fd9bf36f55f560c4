// The friction model `box-converged`: an outer fixed point on the bounds.
#pragma once

#include <span>

#include "solver/solution.h"
#include "solver/step_problem.h"
#include "solver/step_solver.h"

namespace cleave {

inline constexpr int kBoundIterationCap = 50;
inline constexpr double kBoundTolerance = 1e-6;
inline constexpr double kBoundFloor = 1e-6;

// What the fixed point ends on: the largest |bound - mu lambda_n| over the friction rows with a frozen bound,
// relative to max(mu lambda_n, kBoundFloor * the largest mu lambda_n of the step, 1e-12 N s). lambda_n below
// zero counts as zero; 0 where no bound follows a normal impulse. impulse: (m).
double largest_bound_error(const StepProblem& problem, std::span<const double> impulse);

struct ConvergedBounds {
  int solves = 0;             // >= 1
  double error = 0;           // largest_bound_error of the solution
  bool converged = false;     // error <= kBoundTolerance
  SolveSummary last_summary;  // of the last solve; its status is not ok when the solver failed
};

// Solves with the present bounds (those of predict_friction_bounds to begin with), sets them
// to +-mu times the normal impulses found and solves again from there, until largest_bound_error <=
// kBoundTolerance, the solver fails or kBoundIterationCap solves are done. The fixed point need not exist or
// attract; `converged` and `error` say what came out. `problem` is left with the bounds that `solution`
// was solved for, a true MLCP in either case.
ConvergedBounds converge_friction_bounds(StepProblem& problem, StepSolver& solver, const Parts& parts,
                                         Solution& solution);

}  // namespace cleave
