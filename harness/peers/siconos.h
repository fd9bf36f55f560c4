// What Siconos says of impulses: its own measure of how far they are from Coulomb's law.
#pragma once

#include <span>

#include "solver/step_problem.h"

namespace cleave {

// fc3d_compute_error of Siconos, relative to |q|: with u = W r + q, W and q of contact_form.h,
//
//     | r - P(r - (u_n + mu |u_t|, u_t)) | / |q|,
//
// P the projection on the cones |r_t| <= mu r_n, 2-norms over all contacts.
//
// The natural map of de Saxce's form, with step 1 whatever the masses. (By itself Siconos divides by the
// largest of |q|, |r| and |u|.) impulse: (m), of which those of joints are not looked at. Throws as
// ContactForm does.
double siconos_error(const StepProblem& problem, std::span<const double> impulse);

}  // namespace cleave
