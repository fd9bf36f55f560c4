#include "solver/gauss_seidel.h"

#include <algorithm>
#include <cassert>

namespace cleave {

void gauss_seidel_sweeps(const PreparedStep& step, int sweeps, std::span<double> impulse, std::span<double> v,
                         const std::atomic<bool>* stop) {
  const StepProblem& problem = step.problem();
  assert(step.set().axes().empty());
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    check_stop(stop);
    for (const RowGroup& g : step.groups()) {
      // The velocities of the two bodies stay in registers over the rows of the pair.
      double u[12] = {};
      std::copy_n(v.data() + 6 * g.body_a, 6, u);
      if (g.body_b >= 0) std::copy_n(v.data() + 6 * g.body_b, 6, u + 6);
      for (int r = g.first_row; r < g.first_row + g.row_count; ++r) {
        const double* j = problem.jacobian.data() + 12 * r;
        double sum[4] = {};
        for (int c = 0; c < 12; c += 4) {
          for (int k = 0; k < 4; ++k) sum[k] += j[c + k] * u[c + k];
        }
        const double old = impulse[r];
        const double w = (sum[0] + sum[1]) + (sum[2] + sum[3]) + problem.compliance[r] * old - problem.rhs[r];
        const double next = std::clamp(old - w / step.diagonal()[r], problem.lower[r], problem.upper[r]);
        const double change = next - old;
        impulse[r] = next;
        const double* mj = step.mass_jacobian().data() + 12 * r;
        for (int c = 0; c < 12; ++c) u[c] += mj[c] * change;
      }
      std::copy_n(u, 6, v.data() + 6 * g.body_a);
      if (g.body_b >= 0) std::copy_n(u + 6, 6, v.data() + 6 * g.body_b);
    }
  }
}

}  // namespace cleave
