// A dense exact solver of step problems, for tests: semi-smooth Newton in the velocities.
//
// With lambda_r(v) = clamp((b_r - J_r v) / C_r, lo_r, hi_r) the solution is the minimum of the strictly
// convex, piecewise quadratic energy with gradient M (v - v0) - J^T lambda(v). Newton's method with an exact
// line search reaches it in finitely many steps and cannot cycle; refinement in increments then removes what
// the division by C cost. Needs C > 0.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "solver/step_problem.h"

namespace cleave {

struct OracleSolution {
  Eigen::VectorXd impulse;   // (m)
  Eigen::VectorXd velocity;  // (6 n)
  double residual =
      std::numeric_limits<double>::quiet_NaN();  // natural map, m/s; NaN when Newton did not finish
  int iterations = 0;
};

class DenseOracle {
 public:
  explicit DenseOracle(const StepProblem& problem)
      : rows_(problem.row_count()),
        b_(map(problem.rhs)),
        c_(map(problem.compliance)),
        lower_(map(problem.lower)),
        upper_(map(problem.upper)),
        v0_(map(problem.free_velocity)) {
    const int size = 6 * problem.body_count();
    mass_ = Eigen::MatrixXd::Zero(size, size);
    for (int i = 0; i < problem.body_count(); ++i)
      mass_.block<6, 6>(6 * i, 6 * i) = Eigen::Map<const Eigen::Matrix<double, 6, 6>>(&problem.mass[36 * i]);
    jacobian_ = Eigen::MatrixXd::Zero(rows_, size);
    for (int r = 0; r < rows_; ++r)
      for (int side = 0; side < 2; ++side)
        if (const int body = problem.row_body[2 * r + side]; body >= 0)
          for (int k = 0; k < 6; ++k) jacobian_(r, 6 * body + k) += problem.jacobian[12 * r + 6 * side + k];
  }

  OracleSolution solve(int max_iterations = 1000) {
    OracleSolution solution;
    Eigen::VectorXd v = v0_;
    for (; solution.iterations < max_iterations; ++solution.iterations) {
      const std::vector<int> state = row_states(v);
      factor(state);
      const Eigen::VectorXd direction = -factor_.solve(gradient(v));
      // A row that sits on a kink of the energy may change its state for ever by rounding alone.
      const bool at_minimum = direction.norm() <= 1e-13 * (1 + v.norm());
      if (at_minimum || row_states(v + direction) == state) {
        refine(v + direction, state, solution);
        solution.residual = residual(solution.impulse);
        return solution;
      }
      v += line_minimum(v, direction) * direction;
    }
    return solution;
  }

 private:
  using Vector = Eigen::VectorXd;

  static Vector map(const std::vector<double>& values) {
    return Eigen::Map<const Vector>(values.data(), static_cast<Eigen::Index>(values.size()));
  }

  Vector unclamped(const Vector& v) const { return (b_ - jacobian_ * v).cwiseQuotient(c_); }
  Vector clamped(const Vector& impulse) const { return impulse.cwiseMax(lower_).cwiseMin(upper_); }
  Vector gradient(const Vector& v) const {
    return mass_ * (v - v0_) - jacobian_.transpose() * clamped(unclamped(v));
  }

  // -1 at the lower bound, 0 free, 1 at the upper one. The energy is quadratic where no row changes its
  // state.
  std::vector<int> row_states(const Vector& v) const {
    const Vector impulse = unclamped(v);
    std::vector<int> state(rows_);
    for (int r = 0; r < rows_; ++r) state[r] = impulse[r] <= lower_[r] ? -1 : impulse[r] >= upper_[r] ? 1 : 0;
    return state;
  }

  // M + J_F^T C_F^-1 J_F over the free rows F
  void factor(const std::vector<int>& state) {
    Vector stiffness(rows_);
    for (int r = 0; r < rows_; ++r) stiffness[r] = state[r] == 0 ? 1 / c_[r] : 0;
    factor_.compute(mass_ + jacobian_.transpose() * stiffness.asDiagonal() * jacobian_);
  }

  // The slope along the line rises monotonically, so bisection finds its zero.
  double line_minimum(const Vector& v, const Vector& direction) const {
    const Vector start = unclamped(v), change = jacobian_ * direction;
    const double inertial_start = direction.dot(mass_ * (v - v0_)),
                 inertial_rise = direction.dot(mass_ * direction);
    const auto slope = [&](double t) {
      return inertial_start + t * inertial_rise - change.dot(clamped(start - t * change.cwiseQuotient(c_)));
    };
    double low = 0, high = 1;
    while (slope(high) < 0) high *= 2;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      (slope(middle) < 0 ? low : high) = middle;
    }
    return high;
  }

  void refine(Vector v, const std::vector<int>& state, OracleSolution& solution) const {
    Vector impulse = clamped(unclamped(v));
    for (int k = 0; k < 4; ++k) {
      const Vector force_error = jacobian_.transpose() * impulse - mass_ * (v - v0_);
      Vector row_error = b_ - jacobian_ * v - c_.cwiseProduct(impulse);
      for (int r = 0; r < rows_; ++r)
        if (state[r] != 0) row_error[r] = 0;
      const Vector dv = factor_.solve(force_error + jacobian_.transpose() * row_error.cwiseQuotient(c_));
      const Vector row_change = jacobian_ * dv;
      for (int r = 0; r < rows_; ++r)
        if (state[r] == 0) impulse[r] += (row_error[r] - row_change[r]) / c_[r];
      v += dv;
    }
    solution.impulse = impulse;
    solution.velocity = v;
  }

  // max_r d_r |lambda_r - clamp(lambda_r - w_r / d_r)|, from the impulses alone.
  double residual(const Vector& impulse) const {
    const Eigen::MatrixXd response = mass_.llt().solve(jacobian_.transpose());
    const Vector w = jacobian_ * (v0_ + response * impulse) + c_.cwiseProduct(impulse) - b_;
    double largest = 0;
    for (int r = 0; r < rows_; ++r) {
      const double d = jacobian_.row(r).dot(response.col(r)) + c_[r];
      const double step = impulse[r] - std::clamp(impulse[r] - w[r] / d, lower_[r], upper_[r]);
      if (!(std::abs(d * step) <= largest)) largest = std::abs(d * step);
    }
    return largest;
  }

  int rows_;
  Vector b_, c_, lower_, upper_, v0_;
  Eigen::MatrixXd mass_;
  Eigen::MatrixXd jacobian_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
};

inline OracleSolution solve_exactly(const StepProblem& problem) {
  Eigen::setNbThreads(1);  // products this small only wait for their threads
  if (problem.row_count() > 0) return DenseOracle(problem).solve();
  OracleSolution free;
  free.velocity = Eigen::Map<const Eigen::VectorXd>(problem.free_velocity.data(), 6 * problem.body_count());
  free.residual = 0;
  return free;
}

}  // namespace cleave
