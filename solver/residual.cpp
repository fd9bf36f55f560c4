#include "solver/residual.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

namespace cleave {
namespace {

// Sums run in extended precision: with a heavy body on a light one, impulses of 1e5 N s per kg cancel in w,
// and in double the judge would see its own rounding errors.
using Real = long double;
using Vector6 = Eigen::Matrix<Real, 6, 1>;
using ConstVector6 = Eigen::Map<const Eigen::Matrix<double, 6, 1>>;
using ConstMatrix6 = Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// std::max drops a NaN that comes second; here a NaN on either side stays.
double larger_or_nan(double a, double b) { return a > b || std::isnan(a) ? a : b; }

bool all_finite(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

// Cholesky's factor of a mass, M = L L^T, without what leading zeros of a row leave zero: of a body about its centre of mass,
// all between moving and turning.
class MassFactor {
 public:
  MassFactor() {}                    // of nothing yet; its numbers are not worth setting to 0
  void compute(const double* mass);  // (6, 6)

  // M^-1 f; NaN where M is not positive definite.
  Vector6 solve(Vector6 f) const;

 private:
  Real l_[6][6];
  int first_[6];  // column of the first entry of a row that is not zero
  bool is_positive_ = false;
};

void MassFactor::compute(const double* mass) {
  is_positive_ = true;
  for (int i = 0; i < 6; ++i) {
    const double* row = mass + 6 * i;
    first_[i] = static_cast<int>(std::find_if(row, row + i, [](double entry) { return entry != 0; }) - row);
    for (int j = first_[i]; j <= i; ++j) {
      Real sum = 0;
      for (int k = std::max(first_[i], first_[j]); k < j; ++k) sum += l_[i][k] * l_[j][k];
      const Real left = row[j] - sum;
      l_[i][j] = j < i ? left / l_[j][j] : std::sqrt(left);
      is_positive_ = is_positive_ && (j < i || left > 0);
    }
  }
}

Vector6 MassFactor::solve(Vector6 f) const {
  if (!is_positive_) return Vector6::Constant(kNan);
  for (int i = 0; i < 6; ++i) {
    Real sum = 0;
    for (int k = first_[i]; k < i; ++k) sum += l_[i][k] * f[k];
    f[i] = (f[i] - sum) / l_[i][i];
  }
  for (int i = 5; i >= 0; --i) {
    Real sum = 0;
    for (int k = i + 1; k < 6; ++k)
      if (first_[k] <= i) sum += l_[k][i] * f[k];
    f[i] = (f[i] - sum) / l_[i][i];
  }
  return f;
}

// Of all bodies; those that are not needed have zeros for impulses, and no more. Side by side for each quantity: every row
// looks at velocities, and few at the factors, which are far larger.
struct BodyStates {
  explicit BodyStates(int bodies)
      : is_needed(bodies, 0), impulse(bodies, Vector6::Zero()), velocity(bodies), mass_factor(bodies) {}

  std::vector<char> is_needed;
  std::vector<Vector6> impulse;  // J^T lambda
  std::vector<Vector6> velocity;
  std::vector<MassFactor> mass_factor;
};

// Not evaluated: six numbers of extended precision take longer to store than to make anew.
auto jacobian_block(const StepProblem& problem, int row, int side) {
  return ConstVector6(&problem.jacobian[12 * row + 6 * side]).cast<Real>();
}

// Rows that are asked for: (m) 1, or all.
using Asked = std::span<const char>;

bool is_asked(Asked asked, int row) { return asked.empty() || asked[row] != 0; }

void mark_needed(const StepProblem& problem, Asked asked, BodyStates& bodies) {
  if (asked.empty()) std::ranges::fill(bodies.is_needed, 1);
  for (int r = 0; r < static_cast<int>(asked.size()); ++r)
    for (const int body : {problem.row_body[2 * r], problem.row_body[2 * r + 1]})
      if (body >= 0 && asked[r]) bodies.is_needed[body] = 1;
}

// sum += J^T lambda of `count` rows, of the body on one side of all of them. Six sums stay in registers: to store and load
// numbers of extended precision takes several times as long as to add them.
void add_impulses(const double* jacobian, const double* impulse, int count, Vector6& sum) {
  Real s0 = sum[0], s1 = sum[1], s2 = sum[2], s3 = sum[3], s4 = sum[4], s5 = sum[5];
  for (int r = 0; r < count; ++r, jacobian += 12) {
    const Real lambda = impulse[r];
    s0 += jacobian[0] * lambda;
    s1 += jacobian[1] * lambda;
    s2 += jacobian[2] * lambda;
    s3 += jacobian[3] * lambda;
    s4 += jacobian[4] * lambda;
    s5 += jacobian[5] * lambda;
  }
  sum << s0, s1, s2, s3, s4, s5;
}

// The end of the rows from `row` on that join the same bodies.
int end_of_pair(const StepProblem& problem, int row) {
  int end = row + 1;
  while (end < problem.row_count() && problem.row_body[2 * end] == problem.row_body[2 * row] &&
         problem.row_body[2 * end + 1] == problem.row_body[2 * row + 1])
    ++end;
  return end;
}

BodyStates find_body_states(const StepProblem& problem, std::span<const double> impulse, Asked asked = {}) {
  BodyStates bodies(problem.body_count());
  mark_needed(problem, asked, bodies);
  for (int first = 0, last = 0; first < problem.row_count(); first = last) {
    last = end_of_pair(problem, first);
    for (int side = 0; side < 2; ++side) {
      const int body = problem.row_body[2 * first + side];
      if (body >= 0 && bodies.is_needed[body])
        add_impulses(&problem.jacobian[12 * first + 6 * side], &impulse[first], last - first,
                     bodies.impulse[body]);
    }
  }
  for (int i = 0; i < problem.body_count(); ++i) {
    if (!bodies.is_needed[i]) continue;
    bodies.mass_factor[i].compute(&problem.mass[36 * i]);
    bodies.velocity[i] = ConstVector6(&problem.free_velocity[6 * i]).cast<Real>() +
                         bodies.mass_factor[i].solve(bodies.impulse[i]);
  }
  return bodies;
}

// velocity: (n, 6), of which bodies that are not needed keep theirs.
void write_velocities(const BodyStates& bodies, std::span<double> velocity) {
  for (std::size_t i = 0; i < bodies.velocity.size(); ++i)
    for (int k = 0; bodies.is_needed[i] && k < 6; ++k)
      velocity[6 * i + k] = static_cast<double>(bodies.velocity[i][k]);
}

// A row as its bounds see it: itself,
struct PlainRow {
  const StepProblem& problem;
  int row;
  Real rhs, impulse;

  auto jacobian(int side) const { return jacobian_block(problem, row, side); }
};

// or the axis of a turned box that stands in its place.
struct AxisRow {
  std::array<Vector6, 2> blocks;  // of the two bodies
  Real rhs, impulse;

  const Vector6& jacobian(int side) const { return blocks[side]; }
};

PlainRow plain_row(const StepProblem& problem, std::span<const double> impulse, int row) {
  return {problem, row, problem.rhs[row], impulse[row]};
}

bool is_turned(const StepProblem& problem, int row) {
  const int normal = problem.friction_row[row];
  return !problem.box_angle_rad.empty() && normal >= 0 && problem.box_angle_rad[normal] != 0;
}

// Of a turned box with the tangents t1, t2: the first becomes c t1 + s t2, the second c t2 - s t1.
AxisRow axis_of_row(const StepProblem& problem, std::span<const double> impulse, int row) {
  const int normal = problem.friction_row[row];
  const Real angle = problem.box_angle_rad[normal];
  const bool first = row == normal + 1;
  const int other = first ? row + 1 : row - 1;
  const Real own = std::cos(angle), share = first ? std::sin(angle) : -std::sin(angle);
  AxisRow axis;
  for (int side = 0; side < 2; ++side)
    axis.blocks[side] =
        own * jacobian_block(problem, row, side) + share * jacobian_block(problem, other, side);
  axis.rhs = own * problem.rhs[row] + share * problem.rhs[other];
  axis.impulse = own * impulse[row] + share * impulse[other];
  return axis;
}

// d = (J M^-1 J^T + C)_rr. A row that nothing can move (d = 0) is measured with d = 1, which keeps the residual zero
// exactly at solutions.
template <class Row>
Real find_diagonal(const StepProblem& problem, const BodyStates& bodies, int row, const Row& axis) {
  Real diagonal = problem.compliance[row];
  for (int side = 0; side < 2; ++side) {
    const int body = problem.row_body[2 * row + side];
    if (body < 0) continue;
    const Vector6 block = axis.jacobian(side);
    diagonal += block.dot(bodies.mass_factor[body].solve(block));
  }
  return diagonal == 0 ? 1 : diagonal;
}

// w of a row or axis.
template <class Row>
Real find_slack(const StepProblem& problem, const BodyStates& bodies, int row, const Row& axis) {
  Real slack = problem.compliance[row] * axis.impulse - axis.rhs;
  for (int side = 0; side < 2; ++side) {
    const int body = problem.row_body[2 * row + side];
    if (body >= 0) slack += axis.jacobian(side).dot(bodies.velocity[body]);
  }
  return slack;
}

// d | lambda - clamp(lambda - w / d, lo, hi) | of one row, as | clamp(w, d (lambda - hi), d (lambda - lo)) |:
// the same number without the division, whose cancellation would cost eps |lambda| d. d takes longer than all the rest,
// and most rows do without: one at a bound whose w pushes it there has no residual, and as d >= C, a w between
// C (lambda - hi) and C (lambda - lo) is not clamped.
template <class Row>
double find_row_residual(const StepProblem& problem, const BodyStates& bodies, int row, const Row& axis) {
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
using Vector3 = Eigen::Matrix<Real, 3, 1>;

// The nearest point of the polar cone { (n, t): n + mu |t| <= 0 }, which is y - P(y) (Moreau). Outside both cones it
// lies on the polar's surface, s (-mu, t / |t|).
Vector3 project_on_polar(const Vector3& y, Real mu) {
  const Real tangential = std::hypot(y[1], y[2]);
  if (y[0] + mu * tangential <= 0) return y;
  if (tangential <= mu * y[0]) return Vector3::Zero();
  const Real s = (tangential - mu * y[0]) / (1 + mu * mu);
  return {-mu * s, s * y[1] / tangential, s * y[2] / tangential};
}

// d (lambda - P(lambda - w / d)) of one contact, as w + y - P(y) with y = d lambda - w: no difference is left of what is
// large and cancels. Writes one number a row.
void find_contact_residual(const StepProblem& problem, const BodyStates& bodies,
                           std::span<const double> impulse, int normal, std::span<double> residuals) {
  Vector3 lambda = Vector3::Zero(), w = Vector3::Zero();
  Real diagonal = 0;
  for (std::size_t k = 0; k < residuals.size(); ++k) {
    const int row = normal + static_cast<int>(k);
    const PlainRow axis = plain_row(problem, impulse, row);
    lambda[k] = axis.impulse;
    w[k] = find_slack(problem, bodies, row, axis);
    diagonal = std::max(diagonal, find_diagonal(problem, bodies, row, axis));
  }
  const Real mu = problem.friction_coefficient[normal + 1];
  if (problem.contact_set[normal] == ContactSet::coulomb) w[0] += mu * std::hypot(w[1], w[2]);
  const Vector3 apart = w + project_on_polar(diagonal * lambda - w, mu);
  for (std::size_t k = 0; k < residuals.size(); ++k) residuals[k] = static_cast<double>(std::abs(apart[k]));
}

// The rows of the set that begins at a row: of a contact without a box all of them, else the row alone.
int count_rows_of_set(const StepProblem& problem, int row) {
  int count = 1;
  if (problem.contact_set.empty() || problem.contact_set[row] == ContactSet::box) return count;
  while (row + count < problem.row_count() && problem.friction_row[row + count] == row) ++count;
  return count;
}

// (m)
std::vector<double> find_residuals(const StepProblem& problem, const BodyStates& bodies,
                                   std::span<const double> impulse, Asked asked = {}) {
  std::vector<double> residuals(impulse.size());
  for (int r = 0; r < problem.row_count();) {
    const int count = count_rows_of_set(problem, r);
    if (!is_asked(asked, r)) {
      r += count;
      continue;
    }
    if (count == 1) {
      residuals[r] = is_turned(problem, r)
                         ? find_row_residual(problem, bodies, r, axis_of_row(problem, impulse, r))
                         : find_row_residual(problem, bodies, r, plain_row(problem, impulse, r));
    } else {
      find_contact_residual(problem, bodies, impulse, r, std::span(residuals).subspan(r, count));
    }
    r += count;
  }
  return residuals;
}

// The largest entry of |v0|, |J v0| and |b|.
double find_velocity_scale(const StepProblem& problem, double largest_free_velocity) {
  double largest = largest_free_velocity;
  for (int r = 0; r < problem.row_count(); ++r) {
    Real before = 0;  // (J v0)_r
    for (int side = 0; side < 2; ++side) {
      const int body = problem.row_body[2 * r + side];
      if (body < 0) continue;
      before +=
          jacobian_block(problem, r, side).dot(ConstVector6(&problem.free_velocity[6 * body]).cast<Real>());
    }
    largest = larger_or_nan(largest, static_cast<double>(std::abs(before)));
    largest = larger_or_nan(largest, std::abs(problem.rhs[r]));
  }
  return largest;
}

void judge_rows(const StepProblem& problem, const BodyStates& bodies, std::span<const double> impulse,
                ResidualReport& report) {
  const std::vector<double> residuals = find_residuals(problem, bodies, impulse);
  for (int r = 0; r < problem.row_count(); ++r) {
    const double residual = residuals[r];
    double& of_kind = problem.row_kind[r] == RowKind::bilateral ? report.residual_bilateral_m_per_s
                      : problem.row_kind[r] == RowKind::normal  ? report.residual_normal_m_per_s
                                                                : report.residual_friction_m_per_s;
    of_kind = larger_or_nan(of_kind, residual);
    report.residual_m_per_s = larger_or_nan(report.residual_m_per_s, residual);
  }
}

// 1/2 v^T M v - 1/2 v0^T M v0 is (J^T lambda)^T (v0 + v) / 2 because M (v - v0) = J^T lambda: a sum of small
// terms in place of the difference of two large ones.
void judge_energy(const StepProblem& problem, const BodyStates& bodies, std::span<const double> impulse,
                  ResidualReport& report) {
  Real gain = 0;
  Real kinetic = 0;
  for (int i = 0; i < problem.body_count(); ++i) {
    const Vector6& velocity = bodies.velocity[i];
    gain += bodies.impulse[i].dot(velocity + ConstVector6(&problem.free_velocity[6 * i]).cast<Real>()) / 2;
    kinetic += velocity.dot(ConstMatrix6(&problem.mass[36 * i]).cast<Real>() * velocity) / 2;
  }
  for (int r = 0; r < problem.row_count(); ++r) gain -= Real(impulse[r]) * problem.rhs[r];
  report.energy_excess_j = static_cast<double>(gain);
  report.kinetic_energy_j = static_cast<double>(kinetic);
}

// An infinite impulse can meet an infinite bound and look consistent, so nothing but NaN is reported for it.
void report_nan(ResidualReport& report) {
  report.residual_m_per_s = report.residual_relative = report.residual_bilateral_m_per_s =
      report.residual_normal_m_per_s = report.residual_friction_m_per_s = report.energy_excess_j =
          report.kinetic_energy_j = kNan;
  std::fill(report.velocity.begin(), report.velocity.end(), kNan);
}

}  // namespace

ResidualReport judge(const StepProblem& problem, std::span<const double> impulse) {
  assert(std::ssize(impulse) == problem.row_count());
  ResidualReport report;
  report.velocity.resize(problem.free_velocity.size());
  for (const double entry : problem.free_velocity) {
    report.largest_free_velocity_m_per_s =
        larger_or_nan(report.largest_free_velocity_m_per_s, std::abs(entry));
  }
  report.limit_m_per_s = kExactLimit * larger_or_nan(report.largest_free_velocity_m_per_s, 1);

  if (!all_finite(impulse)) {
    report_nan(report);
    return report;
  }
  const BodyStates bodies = find_body_states(problem, impulse);
  write_velocities(bodies, report.velocity);
  judge_rows(problem, bodies, impulse, report);
  const double scale = find_velocity_scale(problem, report.largest_free_velocity_m_per_s);
  report.residual_relative = report.residual_m_per_s == 0 ? 0 : report.residual_m_per_s / scale;
  judge_energy(problem, bodies, impulse, report);
  report.exact = report.residual_m_per_s <= report.limit_m_per_s;
  return report;
}

std::vector<double> row_residuals(const StepProblem& problem, std::span<const double> impulse,
                                  std::span<const char> asked, std::span<double> velocity) {
  assert(std::ssize(impulse) == problem.row_count());
  if (!all_finite(impulse)) return std::vector<double>(impulse.size(), kNan);
  const BodyStates bodies = find_body_states(problem, impulse, asked);
  if (!velocity.empty()) write_velocities(bodies, velocity);
  return find_residuals(problem, bodies, impulse, asked);
}

}  // namespace cleave
