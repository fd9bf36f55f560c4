#include "solver/proximal_step.h"

namespace cleave {

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
