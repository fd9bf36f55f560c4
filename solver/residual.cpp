#include "solver/residual.h"

#include <Eigen/Core>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "solver/residual_bodies.h"
#include "solver/residual_rows.h"

namespace cleave::judging {
namespace {

using ConstMatrix6 = Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// std::max drops a NaN that comes second; here a NaN on either side stays.
double larger_or_nan(double a, double b) { return a > b || std::isnan(a) ? a : b; }

bool all_finite(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

// velocity: (n, 6), of which bodies that are not needed keep theirs.
template <class Real>
void write_velocities(const BodyStates<Real>& bodies, std::span<double> velocity) {
  for (std::size_t i = 0; i < bodies.velocity.size(); ++i)
    for (int k = 0; bodies.is_needed[i] && k < 6; ++k)
      velocity[6 * i + k] = static_cast<double>(bodies.velocity[i].sum()[k]);
}

// The largest entry of |v0|, |J v0| and |b|.
double find_velocity_scale(const StepProblem& problem, double largest_free_velocity) {
  double largest = largest_free_velocity;
  for (int r = 0; r < problem.row_count(); ++r) {
    Extended before = 0;  // (J v0)_r
    for (int side = 0; side < 2; ++side) {
      const int body = problem.row_body[2 * r + side];
      if (body < 0) continue;
      before += jacobian_block<Extended>(problem, r, side)
                    .dot(ConstVector6(&problem.free_velocity[6 * body]).cast<Extended>());
    }
    largest = larger_or_nan(largest, static_cast<double>(std::abs(before)));
    largest = larger_or_nan(largest, std::abs(problem.rhs[r]));
  }
  return largest;
}

void judge_rows(const StepProblem& problem, const BodyStates<Extended>& bodies,
                std::span<const double> impulse, ResidualReport& report) {
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
void judge_energy(const StepProblem& problem, const BodyStates<Extended>& bodies,
                  std::span<const double> impulse, ResidualReport& report) {
  Extended gain = 0;
  Extended kinetic = 0;
  for (int i = 0; i < problem.body_count(); ++i) {
    const Vector6<Extended> velocity = bodies.velocity[i].sum();
    gain +=
        bodies.impulse[i].dot(velocity + ConstVector6(&problem.free_velocity[6 * i]).cast<Extended>()) / 2;
    kinetic += velocity.dot(ConstMatrix6(&problem.mass[36 * i]).cast<Extended>() * velocity) / 2;
  }
  for (int r = 0; r < problem.row_count(); ++r) gain -= Extended(impulse[r]) * problem.rhs[r];
  report.energy_excess_j = static_cast<double>(gain);
  report.kinetic_energy_j = static_cast<double>(kinetic);
}

template <class Real>
std::vector<double> residuals_of_rows(const StepProblem& problem, std::span<const double> impulse,
                                      std::span<const char> asked, std::span<double> velocity) {
  assert(std::ssize(impulse) == problem.row_count());
  if (!all_finite(impulse)) return std::vector<double>(impulse.size(), kNan);
  const BodyStates<Real> bodies = find_body_states<Real>(problem, impulse, asked);
  if (!velocity.empty()) write_velocities(bodies, velocity);
  return find_residuals(problem, bodies, impulse, asked);
}

// An infinite impulse can meet an infinite bound and look consistent, so nothing but NaN is reported for it.
void report_nan(ResidualReport& report) {
  report.residual_m_per_s = report.residual_relative = report.residual_bilateral_m_per_s =
      report.residual_normal_m_per_s = report.residual_friction_m_per_s = report.energy_excess_j =
          report.kinetic_energy_j = kNan;
  std::fill(report.velocity.begin(), report.velocity.end(), kNan);
}

}  // namespace
}  // namespace cleave::judging

namespace cleave {

ResidualReport judge(const StepProblem& problem, std::span<const double> impulse) {
  using namespace judging;
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
  const BodyStates<Extended> bodies = find_body_states<Extended>(problem, impulse);
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
  return judging::residuals_of_rows<judging::Extended>(problem, impulse, asked, velocity);
}

std::vector<double> rough_row_residuals(const StepProblem& problem, std::span<const double> impulse,
                                        std::span<const char> asked, std::span<double> velocity) {
  return judging::residuals_of_rows<double>(problem, impulse, asked, velocity);
}

}  // namespace cleave
