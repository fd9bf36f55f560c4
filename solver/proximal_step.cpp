#include "solver/proximal_step.h"

namespace cleave {
namespace {

constexpr double kLeastCompliance = 1e-12;  // of d_r: below, a factorisation keeps too few digits
constexpr double kDelta = 1e-9;             // of d_r

bool is_rigid(const PreparedStep& step, int row) {
  return step.problem().compliance[row] < kLeastCompliance * step.diagonal()[row];
}

}  // namespace

bool ProximalStep::is_needed(const PreparedStep& step) {
  for (int r = 0; r < step.row_count(); ++r) {
    if (is_rigid(step, r)) return true;
  }
  return false;
}

void ProximalStep::begin(const PreparedStep& step, std::span<const double> centre) {
  problem_ = step.problem();
  original_rhs_ = problem_.rhs;
  delta_.resize(step.row_count());
  for (int r = 0; r < step.row_count(); ++r) {
    delta_[r] = is_rigid(step, r) ? kDelta * step.diagonal()[r] : 0.0;
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
