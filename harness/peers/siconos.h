// What Siconos says of impulses: its own measure of how far they are from Coulomb's law.
#pragma once

#include <span>
#include <string>

#include "solver/step_problem.h"

namespace cleave {

// Why Siconos cannot look at a problem, whatever its contacts obey: it knows nothing but contacts of one normal and two
// tangents. Empty: it can.
std::string find_siconos_refusal(const StepProblem& problem);

// fc3d_compute_error of Siconos, relative to |q|: with u = W r + q, W = J M^-1 J^T + C, q = J v0 - b,
//
//     | r - P(r - (u_n + mu |u_t|, u_t)) | / |q|,    P the projection on the cones |r_t| <= mu r_n,  2-norms over all contacts.
//
// The natural map of de Saxce's form, with step 1 whatever the masses. impulse: (m). Throws std::invalid_argument with
// find_siconos_refusal.
double siconos_error(const StepProblem& problem, std::span<const double> impulse);

}  // namespace cleave
