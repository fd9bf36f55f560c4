// The judge: how far a set of impulses is from solving the step problem.
//
// Written from the arrays of step_problem.h alone and sharing no code with any solver, so that no solver can
// vouch for itself. From lambda: v = v0 + M^-1 J^T lambda, w = J v + C lambda - b, and with d_r = (J M^-1 J^T
// + C)_rr
//
//     residual = max_r d_r | lambda_r - clamp(lambda_r - w_r / d_r, lo_r, hi_r) |          m/s (rad/s)
//
// which is zero exactly at the solution. On the tangent rows of a turned box (StepProblem::box_angle_rad) all
// of this, J, b and lambda included, is taken along the axes of the box. Where the set of a contact is no box
// (StepProblem::contact_set), its rows n, t are measured together, with one d, the largest of theirs:
//
//     cone      d | lambda - P(lambda - w / d) |        P: projection on { (n, t): |t| <= mu n },
//     coulomb   the same with w_n + mu |w_t| in the place of w_n
//
// and each row has its own component. One limit everywhere: exact means
// residual <= kExactLimit * max(1, largest |v0| entry).
//
// The limit is meant for metres and seconds. In other units, or where everything creeps, it may be loose: the
// residual in units of the problem's own velocities, the largest entry of v0, J v0 and b, shows that.
#pragma once

#include <span>
#include <vector>

#include "solver/step_problem.h"

namespace cleave {

struct ResidualReport {
  double residual_m_per_s = 0;            // over all rows
  double residual_bilateral_m_per_s = 0;  // over the rows of one kind; 0 when there is none
  double residual_normal_m_per_s = 0;
  double residual_friction_m_per_s = 0;
  double residual_relative =
      0;  // residual / largest entry of |v0|, |J v0| and |b|; 0 where it is zero itself
  double largest_free_velocity_m_per_s = 0;  // largest |entry| of v0
  // (1/2 v^T M v - 1/2 v0^T M v0) - lambda^T b = lambda^T w - lambda^T C lambda - 1/2 |J^T lambda|^2 in M^-1:
  // an exact step has <= 0 where lambda^T w <= 0. That is so where lo <= 0 <= hi, of a cone, where it is 0
  // for each contact, and under Coulomb's law, where it is -mu lambda_n |w_t|.
  double energy_excess_j = 0;
  double kinetic_energy_j = 0;         // 1/2 v^T M v
  double limit_m_per_s = kExactLimit;  // kExactLimit * max(1, largest_free_velocity_m_per_s)
  bool exact = false;                  // residual within the limit (false for NaN)
  std::vector<double> velocity;        // (n, 6) v recomputed from lambda
};

// impulse: (m). NaN or infinite impulses give a NaN residual and exact = false.
ResidualReport judge(const StepProblem& problem, std::span<const double> impulse);

// (m) The residual of every row, or axis of a turned box in the places of its rows; their maximum is that of
// judge(). All NaN for NaN or infinite impulses. asked: (m) 1 where a row is asked for, the normal row of a
// contact without a box for all of its rows; others have 0. Empty: all. velocity: (n, 6), or empty: becomes v
// on bodies with a row that is asked for, and stays as it is on others.
std::vector<double> row_residuals(const StepProblem& problem, std::span<const double> impulse,
                                  std::span<const char> asked = {}, std::span<double> velocity = {});

// The same in double, several times as fast, for a first look at what the judge sees again: in the residual
// is a rounding error of a few 1e-15 times the velocities that impulses make and that cancel.
std::vector<double> rough_row_residuals(const StepProblem& problem, std::span<const double> impulse,
                                        std::span<const char> asked = {}, std::span<double> velocity = {});

}  // namespace cleave
