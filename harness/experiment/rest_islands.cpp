#include "harness/experiment/rest_islands.h"

#include <algorithm>
#include <numeric>

namespace cleave {

int RestIslands::root_of(int body) {
  while (parent_[body] != body) body = parent_[body] = parent_[parent_[body]];
  return body;
}

void RestIslands::join_bodies(const StepProblem& problem) {
  parent_.resize(problem.body_count());
  std::iota(parent_.begin(), parent_.end(), 0);
  for (int row = 0; row < problem.row_count(); ++row) {
    const int a = problem.row_body[2 * row], b = problem.row_body[2 * row + 1];
    if (a >= 0 && b >= 0) parent_[root_of(a)] = root_of(b);
  }
}

void RestIslands::mark_moving(const StepProblem& problem) {
  v_.resize(problem.free_velocity.size());
  w_.resize(problem.rhs.size());
  step_.velocity(problem.warm_impulse, v_);
  step_.slack(v_, problem.warm_impulse, w_);
  impulse_ = problem.warm_impulse;
  step_.set().to_axes(impulse_);
  step_.set().to_axes(w_);
  is_moving_.assign(problem.body_count(), 0);
  const double limit = kRestLimit * step_.velocity_scale();
  for (const RowGroup& group : step_.groups()) {
    const int first = group.first_row, last = first + group.row_count;
    // Where it is no number, the island is not at rest.
    if (!(step_.set().residual(first, last, step_.diagonal(), impulse_, w_) <= limit))
      is_moving_[root_of(group.body_a)] = 1;
  }
}

const std::vector<char>& RestIslands::find(const StepProblem& problem) {
  is_at_rest_.assign(problem.rhs.size(), 0);
  step_.prepare(problem);
  if (!step_.set().cones().empty()) return is_at_rest_;
  join_bodies(problem);
  mark_moving(problem);
  for (const RowGroup& group : step_.groups())
    if (!is_moving_[root_of(group.body_a)])
      std::fill_n(is_at_rest_.begin() + group.first_row, group.row_count, char(1));
  return is_at_rest_;
}

}  // namespace cleave
