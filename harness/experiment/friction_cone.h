// The friction models `cone` and `coulomb`, and the contacts of a recorded problem under another model.
//
// The sets are those of StepProblem::contact_set. Nothing is predicted: what a friction row may carry hangs
// on the solution itself.
#pragma once

#include <string>

#include "solver/step_problem.h"

namespace cleave {

// Every contact whose friction rows have a coefficient gets the set, and these rows lose their bounds.
void set_cones(StepProblem& problem);
void set_coulomb(StepProblem& problem);

// The same for a problem from anywhere, with one or two tangents; `box` leaves boxes as they are, and gives
// contacts that had another set bounds of mu times predicted normal impulses, as extraction does
// (friction_box.h). Empty, or why it cannot be: a friction row without coefficient that has bounds (it
// follows no normal impulse), or what find_problem_error says of the set. `problem` is then left half done.
std::string turn_contacts(ContactSet set, StepProblem& problem);

}  // namespace cleave
