// Projected Gauss-Seidel sweeps over the rows in their natural order: the predictor of the active-set
// strategies and the baseline `pgs`. One sweep visits every row once:
//
//     w_r = J_r v + C_r lambda_r - b_r,   lambda_r <- clamp(lambda_r - w_r / d_r, lo_r, hi_r),   v += M^-1
//     J_r^T dlambda
#pragma once

#include <span>

#include "solver/prepared_step.h"
#include "solver/stop.h"

namespace cleave {

// Of a problem without turned boxes. impulse (m) and v = v0 + M^-1 J^T impulse (n, 6) are updated in place.
// stop: as in SolveOptions, looked at before every sweep.
void gauss_seidel_sweeps(const PreparedStep& step, int sweeps, std::span<double> impulse, std::span<double> v,
                         const std::atomic<bool>* stop = nullptr);

}  // namespace cleave
