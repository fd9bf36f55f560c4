#include "harness/experiment/friction_box.h"

#include <algorithm>
#include <vector>

#include "harness/experiment/friction.h"
#include "solver/gauss_seidel.h"

namespace cleave {
namespace {

double clamp_impulse(const StepProblem& problem, int row, double impulse, std::span<const double> others) {
  if (!has_frozen_bound(problem, row)) return std::clamp(impulse, problem.lower[row], problem.upper[row]);
  const double bound = coulomb_bound(problem, row, others);
  return std::clamp(impulse, -bound, bound);
}

// The impulses after a few Gauss-Seidel sweeps in which friction bounds move with the normal impulses.
std::vector<double> predicted_impulse(const StepProblem& problem, int sweeps) {
  PreparedStep step;
  step.prepare(problem);
  std::vector<double> impulse(problem.row_count(), 0.0), velocity(problem.free_velocity);
  const auto start_warm = [&](int r, double, double) {
    return clamp_impulse(problem, r, problem.warm_impulse[r], impulse);
  };
  const auto relax = [&](int r, double old, double w) {
    return clamp_impulse(problem, r, old - w / step.diagonal()[r], impulse);
  };
  gauss_seidel_sweep(step, OrderedSlack{}, start_warm, impulse, velocity);
  for (int s = 0; s < sweeps; ++s) gauss_seidel_sweep(step, OrderedSlack{}, relax, impulse, velocity);
  return impulse;
}

}  // namespace

double coulomb_bound(const StepProblem& problem, int row, std::span<const double> impulse) {
  return problem.friction_coefficient[row] * std::max(0.0, impulse[problem.friction_row[row]]);
}

void set_coulomb_bounds(std::span<const double> impulse, StepProblem& problem) {
  for (int r = 0; r < problem.row_count(); ++r) {
    if (!has_frozen_bound(problem, r)) continue;
    problem.upper[r] = coulomb_bound(problem, r, impulse);
    problem.lower[r] = -problem.upper[r];
  }
}

void predict_friction_bounds(StepProblem& problem, int sweeps) {
  set_coulomb_bounds(predicted_impulse(problem, sweeps), problem);
}

}  // namespace cleave
