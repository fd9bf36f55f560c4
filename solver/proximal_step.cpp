#include "solver/proximal_step.h"

#include <algorithm>
#include <limits>

namespace cleave {

double least_relative_compliance(const PreparedStep& step) {
  double least = std::numeric_limits<double>::infinity();
  for (int r = 0; r < step.row_count(); ++r) {
    least = std::min(least, step.problem().compliance[r] / step.diagonal()[r]);
  }
  return least;
}

void ProximalStep::begin(const PreparedStep& step, std::span<const double> centre, double relative_delta) {
  problem_ = step.problem();
  original_rhs_ = problem_.rhs;
  delta_.resize(step.row_count());
  for (int r = 0; r < step.row_count(); ++r) {
    const double delta = relative_delta * step.diagonal()[r];
    delta_[r] = problem_.compliance[r] < delta ? delta : 0.0;
    problem_.compliance[r] += delta_[r];
  }
  recentre(centre);
}

void ProximalStep::recentre(std::span<const double> centre) {
  for (std::size_t r = 0; r < delta_.size(); ++r) {
    problem_.rhs[r] = original_rhs_[r] + delta_[r] * centre[r];
  }
}

}  // namespace cleave
