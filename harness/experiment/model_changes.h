// Step problems with less in them, for what that would change (model_watch.h). All keep the bodies and their
// numbers.
#pragma once

#include <span>
#include <vector>

#include "harness/world/contact_points.h"
#include "solver/step_problem.h"

namespace cleave {

// Without the rows that are 1 in `gone` (m); friction rows go with their normal row.
StepProblem without_rows(const StepProblem& problem, std::vector<char> gone);

// The friction rows that are 1 in `held` (m), all of a contact or none, have no bounds and no cone.
StepProblem with_bilateral_rows(const StepProblem& problem, std::span<const char> held);

// The bodies that are 1 in `fixed` (n) are static: rows between them and static geometry go, and they keep
// their free velocity of 0.
StepProblem with_static_bodies(const StepProblem& problem, std::span<const char> fixed);

// (m) 1 for the normal rows of contacts behind the first `most` of a pair of geoms, as a cap counts them. The
// normal rows stand in the order of the contacts.
std::vector<char> contacts_behind(const StepProblem& problem, std::span<const ContactPoint> contacts,
                                  int most);

}  // namespace cleave
