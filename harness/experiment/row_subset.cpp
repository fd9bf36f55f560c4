#include "harness/experiment/row_subset.h"

#include <cassert>

namespace cleave {

void copy_rows(const StepProblem& problem, std::span<const char> is_kept, StepProblem& reduced,
               std::vector<int>& new_row) {
  const auto copy = [is_kept](const auto& values, auto& kept, std::size_t width = 1) {
    keep_rows(values, is_kept, kept, width);
  };
  reduced.h_s = problem.h_s;
  reduced.mass = problem.mass;
  reduced.free_velocity = problem.free_velocity;
  copy(problem.row_body, reduced.row_body, 2);
  copy(problem.jacobian, reduced.jacobian, 12);
  copy(problem.rhs, reduced.rhs);
  copy(problem.compliance, reduced.compliance);
  copy(problem.lower, reduced.lower);
  copy(problem.upper, reduced.upper);
  copy(problem.row_kind, reduced.row_kind);
  copy(problem.friction_row, reduced.friction_row);
  copy(problem.friction_coefficient, reduced.friction_coefficient);
  copy(problem.row_constraint, reduced.row_constraint);
  copy(problem.contact_point, reduced.contact_point, 3);
  copy(problem.warm_impulse, reduced.warm_impulse);
  copy(problem.box_angle_rad, reduced.box_angle_rad);
  copy(problem.contact_set, reduced.contact_set);
  new_row.assign(is_kept.size(), -1);
  for (std::size_t row = 0, next = 0; row < is_kept.size(); ++row)
    if (is_kept[row] != 0) new_row[row] = static_cast<int>(next++);
  for (int& normal : reduced.friction_row) {
    if (normal < 0) continue;
    normal = new_row[normal];
    assert(normal >= 0);
  }
}

}  // namespace cleave
