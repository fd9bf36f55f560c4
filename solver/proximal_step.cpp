#include "solver/proximal_step.h"

#include <algorithm>

namespace cleave {

void ProximalStep::begin(const PreparedStep& step, std::span<const double> centre, double relative_delta) {
  problem_ = step.problem();
  set_.bind(problem_);
  original_rhs_ = problem_.rhs;
  delta_.resize(step.row_count());
  for (int r = 0; r < step.row_count(); ++r) delta_[r] = relative_delta * step.diagonal()[r];
  for (const WeightBlock& block : set_.axes()) {
    double* tangents = delta_.data() + block.first_row + 1;
    tangents[0] = tangents[1] = std::max(tangents[0], tangents[1]);
  }
  for (int r = 0; r < step.row_count(); ++r) {
    if (problem_.compliance[r] >= delta_[r]) delta_[r] = 0;
    problem_.compliance[r] += delta_[r];
  }
  recentre(centre);
}

void ProximalStep::recentre(std::span<const double> centre) {
  const std::span<const double> in_rows = set_.in_rows(centre, in_rows_);
  for (std::size_t r = 0; r < delta_.size(); ++r) {
    problem_.rhs[r] = original_rhs_[r] + delta_[r] * in_rows[r];
  }
}

}  // namespace cleave
