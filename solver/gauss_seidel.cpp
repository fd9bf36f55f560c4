#include "solver/gauss_seidel.h"

#include <cassert>

namespace cleave {

void gauss_seidel_sweeps(const PreparedStep& step, int sweeps, std::span<double> impulse, std::span<double> v,
                         const std::atomic<bool>* stop) {
  assert(step.set().axes().empty());
  const StepProblem& problem = step.problem();
  const auto within_bounds = [&](int r, double old, double w) {
    return std::clamp(old - w / step.diagonal()[r], problem.lower[r], problem.upper[r]);
  };
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    check_stop(stop);
    gauss_seidel_sweep(step, LaneSlack{}, within_bounds, impulse, v);
  }
}

}  // namespace cleave
