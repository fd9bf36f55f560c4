// Projected Gauss-Seidel: the predictor of the strategy `newton`, the baselines `pgs`, `pgs-colored`,
// `pgs-parts` and the prediction of friction bounds. One sweep visits every row once, in natural order unless
// a baseline has another:
//
//     w_r = J_r v + C_r lambda_r - b_r,   lambda_r <- next(r, lambda_r, w_r),   v += M^-1 J_r^T dlambda
//
// with next = clamp(lambda_r - w_r / d_r, lo_r, hi_r) for fixed bounds.
#pragma once

#include <algorithm>
#include <span>

#include "harness/base/stop.h"
#include "solver/group_products.h"
#include "solver/prepared_step.h"

namespace cleave {

// Of a problem without turned boxes. impulse (m) and v = v0 + M^-1 J^T impulse (n, 6) are updated in place.
// stop: as in SolveOptions, looked at before every sweep.
void gauss_seidel_sweeps(const PreparedStep& step, int sweeps, std::span<double> impulse, std::span<double> v,
                         const std::atomic<bool>* stop);

// w_r with J_r u summed in lanes. u (12): velocities of the row's two bodies.
struct LaneSlack {
  double operator()(const StepProblem& problem, int row, const double* u, double impulse) const {
    return row_times(problem.jacobian.data() + 12L * row, load_pair(u)) + problem.compliance[row] * impulse -
           problem.rhs[row];
  }
};

// w_r summed term after term: the order that what goes into a problem is defined by, as problems are told by
// their bytes.
struct OrderedSlack {
  double operator()(const StepProblem& problem, int row, const double* u, double impulse) const {
    const double* j = problem.jacobian.data() + 12L * row;
    double w = problem.compliance[row] * impulse - problem.rhs[row];
    for (int c = 0; c < 12; ++c) w += j[c] * u[c];
    return w;
  }
};

// Visits the rows of one group once, on the velocities u (12) of its two bodies, of which they are those
// after it, with any bounds: next(row, impulse, w) is the new impulse of the row; it may look at the impulses
// of other rows as they are by then. moved(c, change): by how much entry c moves where it is a whole body
// that moves by `change`.
template <typename Slack, typename Next, typename Moved>
void gauss_seidel_rows(const PreparedStep& step, const RowGroup& g, const Slack& slack, const Next& next,
                       const Moved& moved, std::span<double> impulse, double* u) {
  const StepProblem& problem = step.problem();
  for (int r = g.first_row; r < g.first_row + g.row_count; ++r) {
    const double old = impulse[r];
    impulse[r] = next(r, old, slack(problem, r, u, old));
    const double change = impulse[r] - old;
    const double* mj = step.mass_jacobian().data() + 12L * r;
    for (int c = 0; c < 12; ++c) u[c] += moved(c, mj[c] * change);
  }
}

// The same with the velocities of the bodies themselves, v (n, 6), which stay in registers over the rows.
template <typename Slack, typename Next>
void gauss_seidel_visit(const PreparedStep& step, const RowGroup& g, const Slack& slack, const Next& next,
                        std::span<double> impulse, std::span<double> v) {
  double u[12] = {};
  std::copy_n(v.data() + 6L * g.body_a, 6, u);
  if (g.body_b >= 0) std::copy_n(v.data() + 6L * g.body_b, 6, u + 6);
  gauss_seidel_rows(
      step, g, slack, next, [](int, double change) { return change; }, impulse, u);
  std::copy_n(u, 6, v.data() + 6L * g.body_a);
  if (g.body_b >= 0) std::copy_n(u + 6, 6, v.data() + 6L * g.body_b);
}

// One sweep over all groups.
template <typename Slack, typename Next>
void gauss_seidel_sweep(const PreparedStep& step, const Slack& slack, const Next& next,
                        std::span<double> impulse, std::span<double> v) {
  for (const RowGroup& g : step.groups()) gauss_seidel_visit(step, g, slack, next, impulse, v);
}

// clamp(lambda_r - w_r / d_r, lo_r, hi_r), of a problem without turned boxes; inverse_diagonal: (m) 1 / d_r.
// A row waits for the one before it, and would wait twice as long for a division.
struct WithinBounds {
  const StepProblem& problem;
  std::span<const double> inverse_diagonal;
  explicit WithinBounds(const PreparedStep& step)
      : problem(step.problem()), inverse_diagonal(step.inverse_diagonal()) {}
  WithinBounds(const StepProblem& rows, std::span<const double> inverse)
      : problem(rows), inverse_diagonal(inverse) {}

  double operator()(int r, double old, double w) const {
    return std::clamp(old - w * inverse_diagonal[r], problem.lower[r], problem.upper[r]);
  }
};

}  // namespace cleave
