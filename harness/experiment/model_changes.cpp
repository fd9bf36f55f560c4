#include "harness/experiment/model_changes.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "harness/experiment/row_subset.h"

namespace cleave {
namespace {

// The body on this side of the row becomes static: the other one stands first.
void fix_side(StepProblem& problem, int row, int side) {
  if (side == 0) {
    std::swap(problem.row_body[2 * std::size_t(row)], problem.row_body[2 * std::size_t(row) + 1]);
    const auto first = problem.jacobian.begin() + 12 * std::ptrdiff_t(row);
    std::swap_ranges(first, first + 6, first + 6);
  }
  problem.row_body[2 * std::size_t(row) + 1] = -1;
  std::fill_n(problem.jacobian.begin() + 12 * std::ptrdiff_t(row) + 6, 6, 0.0);
}

}  // namespace

StepProblem without_rows(const StepProblem& problem, std::vector<char> gone) {
  for (int row = 0; row < problem.row_count(); ++row)
    if (const int normal = problem.friction_row[row]; normal >= 0 && gone[normal] != 0) gone[row] = 1;
  std::vector<char> is_kept;
  for (const char is_gone : gone) is_kept.push_back(is_gone == 0);
  StepProblem reduced;
  std::vector<int> new_row;
  copy_rows(problem, is_kept, reduced, new_row);
  return reduced;
}

StepProblem with_bilateral_rows(const StepProblem& problem, std::span<const char> held) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  StepProblem changed = problem;
  for (int row = 0; row < problem.row_count(); ++row) {
    if (held[row] == 0) continue;
    changed.lower[row] = -kInfinity;
    changed.upper[row] = kInfinity;
    if (!changed.contact_set.empty()) changed.contact_set[problem.friction_row[row]] = ContactSet::box;
  }
  return changed;
}

StepProblem with_static_bodies(const StepProblem& problem, std::span<const char> fixed) {
  StepProblem changed = problem;
  std::vector<char> gone(problem.rhs.size(), 0);
  const auto is_still = [&fixed](int body) { return body < 0 || fixed[body] != 0; };
  for (int row = 0; row < problem.row_count(); ++row) {
    const int a = problem.row_body[2 * std::size_t(row)], b = problem.row_body[2 * std::size_t(row) + 1];
    if (is_still(a) && is_still(b)) {
      gone[row] = 1;
    } else if (is_still(a)) {
      fix_side(changed, row, 0);
    } else if (b >= 0 && is_still(b)) {
      fix_side(changed, row, 1);
    }
  }
  for (std::size_t i = 0; i < fixed.size(); ++i)
    if (fixed[i] != 0) std::fill_n(changed.free_velocity.begin() + 6 * std::ptrdiff_t(i), 6, 0.0);
  return without_rows(changed, std::move(gone));
}

std::vector<char> contacts_behind(const StepProblem& problem, std::span<const ContactPoint> contacts,
                                  int most) {
  std::map<std::pair<int, int>, int> of_geoms;
  std::vector<char> behind(problem.rhs.size(), 0);
  std::size_t next = 0;
  for (int row = 0; row < problem.row_count(); ++row) {
    if (problem.row_kind[row] != RowKind::normal) continue;
    const ContactPoint& contact = contacts[next++];
    behind[row] = ++of_geoms[std::minmax(contact.geom_a, contact.geom_b)] > most;
  }
  return behind;
}

}  // namespace cleave
