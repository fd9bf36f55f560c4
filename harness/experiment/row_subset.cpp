#include "harness/experiment/row_subset.h"

#include <cassert>

#include "solver/row_arrays.h"

namespace cleave {

void copy_rows(const StepProblem& problem, std::span<const char> is_kept, StepProblem& reduced,
               std::vector<int>& new_row) {
  reduced.h_s = problem.h_s;
  reduced.mass = problem.mass;
  reduced.free_velocity = problem.free_velocity;
  visit_row_arrays([&](const char*, auto member, std::size_t width, RowArray) {
    keep_rows(problem.*member, is_kept, reduced.*member, width);
  });
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
