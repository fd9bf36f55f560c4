#include "harness/experiment/friction_cone.h"

#include <algorithm>
#include <limits>

#include "harness/base/numbers.h"
#include "harness/experiment/friction.h"
#include "harness/experiment/friction_box.h"

namespace cleave {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

void give_set(ContactSet set, StepProblem& problem) {
  for (int r = 0; r < problem.row_count(); ++r) {
    if (!(problem.friction_coefficient[r] > 0)) continue;
    if (problem.contact_set.empty()) problem.contact_set.assign(problem.row_count(), ContactSet::box);
    problem.contact_set[problem.friction_row[r]] = set;
    problem.lower[r] = -kInfinity;
    problem.upper[r] = kInfinity;
  }
}

// Boxes beside cones keep their bounds.
void give_boxes(StepProblem& problem) {
  const auto is_curved = [](ContactSet set) { return set != ContactSet::box; };
  if (std::ranges::none_of(problem.contact_set, is_curved)) return;
  StepProblem predicted = problem;
  predicted.contact_set.clear();
  predict_friction_bounds(predicted);
  for (int r = 0; r < problem.row_count(); ++r) {
    if (!(problem.friction_coefficient[r] > 0) || has_frozen_bound(problem, r)) continue;
    problem.lower[r] = predicted.lower[r];
    problem.upper[r] = predicted.upper[r];
  }
  problem.contact_set.clear();
}

// A row that nothing may move along is no friction, whatever its coefficient.
std::string find_bound_without_coefficient(const StepProblem& problem) {
  for (int r = 0; r < problem.row_count(); ++r) {
    if (problem.row_kind[r] != RowKind::friction || problem.friction_coefficient[r] > 0) continue;
    if (problem.lower[r] != 0 || problem.upper[r] != 0)
      return "friction_coefficient[" + std::to_string(r) + "] = 0 with bounds " +
             number_text(problem.lower[r]) + " and " + number_text(problem.upper[r]) +
             ", allowed: a coefficient, as these bounds follow no normal impulse";
  }
  return {};
}

}  // namespace

void set_cones(StepProblem& problem) { give_set(ContactSet::cone, problem); }
void set_coulomb(StepProblem& problem) { give_set(ContactSet::coulomb, problem); }

std::string turn_contacts(ContactSet set, StepProblem& problem) {
  if (set == ContactSet::box) {
    give_boxes(problem);
    return {};
  }
  if (std::string error = find_bound_without_coefficient(problem); !error.empty()) return error;
  give_set(set, problem);
  return find_problem_error(problem);
}

}  // namespace cleave
