#include "harness/experiment/friction_mismatch.h"

#include <cassert>
#include <cmath>
#include <limits>

#include "harness/experiment/friction.h"
#include "harness/experiment/friction_box.h"

namespace cleave {

FrictionMismatch friction_mismatch(const StepProblem& problem, std::span<const double> impulse) {
  assert(static_cast<int>(impulse.size()) == problem.row_count());
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kRounding = 1e-9;  // of an impulse at its bound
  double apart = 0, carried = 0;
  int rows = 0, beyond = 0;
  for (int r = 0; r < problem.row_count(); ++r) {
    if (!has_frozen_bound(problem, r)) continue;
    const double bound = coulomb_bound(problem, r, impulse);
    apart += std::abs(problem.upper[r] - bound);
    carried += bound;
    ++rows;
    beyond += std::abs(impulse[r]) > bound * (1 + kRounding);
  }
  if (!(carried > 0)) return {kNan, kNan};
  return {apart / carried, static_cast<double>(beyond) / rows};
}

}  // namespace cleave
