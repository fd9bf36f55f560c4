// Between a step problem (solver/step_problem.h) and the global form of FCLIB (fclib_file.h). The signs are
// the same on both sides: w = J v + C lambda - b of a row is u of its column.
//
//     body i            unknowns 6 i to 6 i + 5, block M_i of M, entries M_i v0_i of f
//     bilateral row     the next column of G: J_r^T, b = -b_r
//     contact           the next columns of H, normal first: J_r^T, w = -b_r
//     compliance C_r    if not 0, a spring: one more unknown s behind those of the bodies, 1 / C_r on the
//                       diagonal of M, 0 in f and 1 in the column of the row. Then s = C_r lambda_r, which
//                       H^T v or G^T v adds to J_r v; so FCLIB's W = H^T M^-1 H is our J M^-1 J^T + C
//
// FCLIB knows Coulomb's law alone. A contact without friction has mu = 0 and columns of tangents that are
// empty; it comes back as its normal row. Tangents of a coefficient 0 whose bounds are 0 go as they are, and
// do not come back.
#pragma once

#include <optional>

#include "harness/files/fclib_file.h"
#include "solver/step_problem.h"

namespace cleave {

// Contacts have two tangents (spacedim 3), or all that have friction have one (spacedim 2). Throws
// std::invalid_argument with one line that names the row: bounds other than (-inf, inf), (0, inf) and those
// of friction; friction that is a box or the convex cone; one tangent among contacts of two; friction rows
// that do not follow their normal row.
FclibGlobal fclib_of_problem(const StepProblem& problem);

// The arrays of the problem that a file must have, and those of friction; rows of joints come before those of
// contacts. Of the two bodies of a row the first has the lower index.
//
// unknowns_of_body: 6 (linear, angular) or 3: with spacedim 2 (x, y, angle about z), with 3 (x, y, z of a
// point). What 3 lack is at rest and in no row; it gets the mass of x, and as moment of inertia the last
// entry of the block's diagonal. Not given: 6, but for spacedim 2 in files that are not ours 3. Throws
// std::invalid_argument with one line, without the file: unknowns that make no whole number of bodies, an M
// that couples bodies or is not positive definite, columns of more than two bodies or of none, springs of
// more than one column.
StepProblem problem_of_fclib(const FclibGlobal& global, std::optional<int> unknowns_of_body);

}  // namespace cleave
