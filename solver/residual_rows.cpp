#include "solver/residual_rows.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace cleave::judging {
namespace {

// A row as its bounds see it: itself,
template <class Real>
struct PlainRow {
  const StepProblem& problem;
  int row;
  Real rhs, impulse;

  auto jacobian(int side) const { return jacobian_block<Real>(problem, row, side); }
};

// or the axis of a turned box that stands in its place.
template <class Real>
struct AxisRow {
  std::array<Vector6<Real>, 2> blocks;  // of the two bodies
  Real rhs, impulse;

  const Vector6<Real>& jacobian(int side) const { return blocks[side]; }
};

template <class Real>
PlainRow<Real> plain_row(const StepProblem& problem, std::span<const double> impulse, int row) {
  return {problem, row, problem.rhs[row], impulse[row]};
}

bool is_turned(const StepProblem& problem, int row) {
  const int normal = problem.friction_row[row];
  return !problem.box_angle_rad.empty() && normal >= 0 && problem.box_angle_rad[normal] != 0;
}

// Of a turned box with the tangents t1, t2: the first becomes c t1 + s t2, the second c t2 - s t1.
template <class Real>
AxisRow<Real> axis_of_row(const StepProblem& problem, std::span<const double> impulse, int row) {
  const int normal = problem.friction_row[row];
  const Real angle = problem.box_angle_rad[normal];
  const bool first = row == normal + 1;
  const int other = first ? row + 1 : row - 1;
  const Real own = std::cos(angle), share = first ? std::sin(angle) : -std::sin(angle);
  AxisRow<Real> axis;
  for (int side = 0; side < 2; ++side)
    axis.blocks[side] =
        own * jacobian_block<Real>(problem, row, side) + share * jacobian_block<Real>(problem, other, side);
  axis.rhs = own * problem.rhs[row] + share * problem.rhs[other];
  axis.impulse = own * impulse[row] + share * impulse[other];
  return axis;
}

// d = (J M^-1 J^T + C)_rr. A row that nothing can move (d = 0) is measured with d = 1, which keeps the
// residual zero exactly at solutions.
template <class Real, class Row>
Real find_diagonal(const StepProblem& problem, const BodyStates<Real>& bodies, int row, const Row& axis) {
  Real diagonal = problem.compliance[row];
  for (int side = 0; side < 2; ++side) {
    const int body = problem.row_body[2 * row + side];
    if (body < 0) continue;
    const Vector6<Real> block = axis.jacobian(side);
    diagonal += block.dot(bodies.mass_factor[body].solve(block));
  }
  return diagonal == 0 ? 1 : diagonal;
}

// w of a row or axis. The speeds of both sides come first: a sum that waits for each of them in turn goes
// through memory, where numbers are extended.
template <class Real, class Row>
Real find_slack(const StepProblem& problem, const BodyStates<Real>& bodies, int row, const Row& axis) {
  const auto speed = [&](int side) {
    const int body = problem.row_body[2 * row + side];
    return body < 0 ? Real(0) : axis.jacobian(side).dot(bodies.velocity[body].sum());
  };
  const Real of_a = speed(0), of_b = speed(1);
  return problem.compliance[row] * axis.impulse - axis.rhs + of_a + of_b;
}

// d | lambda - clamp(lambda - w / d, lo, hi) | of one row, as | clamp(w, d (lambda - hi), d (lambda - lo)) |:
// the same number without the division, whose cancellation would cost eps |lambda| d. d takes longer than all
// the rest, and most rows do without: one at a bound whose w pushes it there has no residual, and as d >= C,
// a w between C (lambda - hi) and C (lambda - lo) is not clamped.
template <class Real, class Row>
double find_row_residual(const StepProblem& problem, const BodyStates<Real>& bodies, int row,
                         const Row& axis) {
  const Real compliance = problem.compliance[row];
  const Real slack = find_slack(problem, bodies, row, axis);
  const Real above_lower = axis.impulse - problem.lower[row], above_upper = axis.impulse - problem.upper[row];
  if ((above_lower == 0 && slack >= 0 && above_upper <= 0) ||
      (above_upper == 0 && slack <= 0 && above_lower >= 0))
    return 0;
  const bool is_free = above_lower >= 0 && above_upper <= 0 && slack <= compliance * above_lower &&
                       slack >= compliance * above_upper;
  if (is_free) return static_cast<double>(std::abs(slack));
  const Real diagonal = find_diagonal(problem, bodies, row, axis);
  return static_cast<double>(std::abs(std::clamp(slack, diagonal * above_upper, diagonal * above_lower)));
}

// The rows of a contact: normal, then its tangents, one or two of which the second then stays zero.
template <class Real>
using Vector3 = Eigen::Matrix<Real, 3, 1>;

// The nearest point of the polar cone { (n, t): n + mu |t| <= 0 }, which is y - P(y) (Moreau). Outside both
// cones it lies on the polar's surface, s (-mu, t / |t|).
template <class Real>
Vector3<Real> project_on_polar(const Vector3<Real>& y, Real mu) {
  const Real tangential = std::hypot(y[1], y[2]);
  if (y[0] + mu * tangential <= 0) return y;
  if (tangential <= mu * y[0]) return Vector3<Real>::Zero();
  const Real s = (tangential - mu * y[0]) / (1 + mu * mu);
  return {-mu * s, s * y[1] / tangential, s * y[2] / tangential};
}

// d (lambda - P(lambda - w / d)) of one contact, as w + y - P(y) with y = d lambda - w: no difference is left
// of what is large and cancels. Writes one number a row.
template <class Real>
void find_contact_residual(const StepProblem& problem, const BodyStates<Real>& bodies,
                           std::span<const double> impulse, int normal, std::span<double> residuals) {
  Vector3<Real> lambda = Vector3<Real>::Zero(), w = Vector3<Real>::Zero();
  Real diagonal = 0;
  for (std::size_t k = 0; k < residuals.size(); ++k) {
    const int row = normal + static_cast<int>(k);
    const PlainRow<Real> axis = plain_row<Real>(problem, impulse, row);
    lambda[k] = axis.impulse;
    w[k] = find_slack(problem, bodies, row, axis);
    diagonal = std::max(diagonal, find_diagonal(problem, bodies, row, axis));
  }
  const Real mu = problem.friction_coefficient[normal + 1];
  if (problem.contact_set[normal] == ContactSet::coulomb) w[0] += mu * std::hypot(w[1], w[2]);
  const Vector3<Real> apart = w + project_on_polar<Real>(diagonal * lambda - w, mu);
  for (std::size_t k = 0; k < residuals.size(); ++k) residuals[k] = static_cast<double>(std::abs(apart[k]));
}

// The rows of the set that begins at a row: of a contact without a box all of them, else the row alone.
int count_rows_of_set(const StepProblem& problem, int row) {
  int count = 1;
  if (problem.contact_set.empty() || problem.contact_set[row] == ContactSet::box) return count;
  while (row + count < problem.row_count() && problem.friction_row[row + count] == row) ++count;
  return count;
}

}  // namespace

template <class Real>
std::vector<double> find_residuals(const StepProblem& problem, const BodyStates<Real>& bodies,
                                   std::span<const double> impulse, std::span<const char> asked) {
  std::vector<double> residuals(impulse.size());
  for (int r = 0; r < problem.row_count();) {
    const int count = count_rows_of_set(problem, r);
    if (!asked.empty() && asked[r] == 0) {
      r += count;
      continue;
    }
    if (count == 1) {
      residuals[r] = is_turned(problem, r)
                         ? find_row_residual(problem, bodies, r, axis_of_row<Real>(problem, impulse, r))
                         : find_row_residual(problem, bodies, r, plain_row<Real>(problem, impulse, r));
    } else {
      find_contact_residual(problem, bodies, impulse, r, std::span(residuals).subspan(r, count));
    }
    r += count;
  }
  return residuals;
}

template std::vector<double> find_residuals(const StepProblem&, const BodyStates<double>&,
                                            std::span<const double>, std::span<const char>);
template std::vector<double> find_residuals(const StepProblem&, const BodyStates<Extended>&,
                                            std::span<const double>, std::span<const char>);

}  // namespace cleave::judging
