// min |A x - b|^2 over x >= 0, for the few unknowns of a model of costs.
//
// One coordinate after the other is set to its best value, the others held (Franc, Hlavac and Navara,
// "Sequential coordinate-wise algorithm for the non-negative least squares problem", CAIP 2005): with H = A^T
// A and the gradient g = H x - A^T b,
//
//     x_k <- max(0, x_k - g_k / H_kk)
//
// until the conditions of the optimum hold: g_k = 0 where x_k > 0, g_k >= 0 elsewhere. Columns are scaled to
// length 1 before, so that the tolerance has no unit.
#pragma once

#include <span>
#include <vector>

namespace cleave {

// a: (rows, unknowns) row by row; b: (rows). Returns (unknowns). A column of zeros gets 0. Unknowns that
// columns do not tell apart get one of the best answers.
std::vector<double> nonnegative_least_squares(std::span<const double> a, std::span<const double> b,
                                              int unknowns);

}  // namespace cleave
