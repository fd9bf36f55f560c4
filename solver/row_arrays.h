// The arrays of a StepProblem that have an entry a row, for all that is done to each of them alike.
#pragma once

#include <cstddef>

#include "solver/step_problem.h"

namespace cleave {

// Whether an array has entries in every problem, or none where no contact needs them.
enum class RowArray { always, may_be_empty };

// visit(name, member, width, RowArray): problem.*member has width numbers a row. In the order of
// problem_hash.
template <class Visit>
void visit_row_arrays(const Visit& visit) {
  using enum RowArray;
  visit("row_body", &StepProblem::row_body, std::size_t{2}, always);
  visit("jacobian", &StepProblem::jacobian, std::size_t{12}, always);
  visit("rhs", &StepProblem::rhs, std::size_t{1}, always);
  visit("compliance", &StepProblem::compliance, std::size_t{1}, always);
  visit("lower", &StepProblem::lower, std::size_t{1}, always);
  visit("upper", &StepProblem::upper, std::size_t{1}, always);
  visit("row_kind", &StepProblem::row_kind, std::size_t{1}, always);
  visit("friction_row", &StepProblem::friction_row, std::size_t{1}, always);
  visit("friction_coefficient", &StepProblem::friction_coefficient, std::size_t{1}, always);
  visit("row_constraint", &StepProblem::row_constraint, std::size_t{1}, always);
  visit("contact_point", &StepProblem::contact_point, std::size_t{3}, always);
  visit("warm_impulse", &StepProblem::warm_impulse, std::size_t{1}, always);
  visit("box_angle_rad", &StepProblem::box_angle_rad, std::size_t{1}, may_be_empty);
  visit("contact_set", &StepProblem::contact_set, std::size_t{1}, may_be_empty);
}

}  // namespace cleave
