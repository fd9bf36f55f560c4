#include "harness/experiment/friction_converged.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "harness/experiment/friction.h"
#include "harness/experiment/friction_box.h"

namespace cleave {

double largest_bound_error(const StepProblem& problem, std::span<const double> impulse) {
  assert(static_cast<int>(impulse.size()) == problem.row_count());
  double largest_bound = 0;
  for (int r = 0; r < problem.row_count(); ++r)
    if (has_frozen_bound(problem, r))
      largest_bound = std::max(largest_bound, coulomb_bound(problem, r, impulse));
  const double floor = std::max(kBoundFloor * largest_bound, 1e-12);
  double error = 0;
  for (int r = 0; r < problem.row_count(); ++r) {
    if (!has_frozen_bound(problem, r)) continue;
    const double bound = coulomb_bound(problem, r, impulse);
    error = std::max(error, std::abs(problem.upper[r] - bound) / std::max(bound, floor));
  }
  return error;
}

ConvergedBounds converge_friction_bounds(StepProblem& problem, StepSolver& solver, const Parts& parts,
                                         Solution& solution) {
  ConvergedBounds result;
  while (true) {
    result.last_summary = solver.solve(problem, parts, solution);
    ++result.solves;
    result.error = largest_bound_error(problem, solution.impulse);
    if (result.last_summary.status != SolveStatus::ok) return result;
    result.converged = result.error <= kBoundTolerance;
    if (result.converged || result.solves == kBoundIterationCap) return result;
    set_coulomb_bounds(solution.impulse, problem);
  }
}

}  // namespace cleave
