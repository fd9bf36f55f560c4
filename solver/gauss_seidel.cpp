#include "solver/gauss_seidel.h"

#include <cassert>

namespace cleave {

void gauss_seidel_sweeps(const PreparedStep& step, int sweeps, std::span<double> impulse, std::span<double> v,
                         const std::atomic<bool>* stop) {
  assert(step.set().axes().empty());
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    check_stop(stop);
    gauss_seidel_sweep(step, LaneSlack{}, WithinBounds(step), impulse, v);
  }
}

}  // namespace cleave
