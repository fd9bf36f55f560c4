#include "tests/solver/enumeration_oracle.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace cleave {
namespace {

using Real = long double;
using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
using RowMatrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic, 0, kOracleMostRows, kOracleMostRows>;
using RowVector = Eigen::Matrix<Real, Eigen::Dynamic, 1, 0, kOracleMostRows, 1>;

enum class RowState { free, at_lower, at_upper };

struct DenseProblem {
  Matrix inverse_mass;  // (6n, 6n)
  Matrix jacobian;      // (m, 6n)
  Vector free_velocity;
  RowMatrix effective;  // A
  RowVector offset;     // q
  RowVector lower, upper;
};

DenseProblem make_dense(const StepProblem& problem) {
  const int n = problem.body_count();
  const int m = problem.row_count();
  DenseProblem dense;
  dense.inverse_mass = Matrix::Zero(6 * n, 6 * n);
  dense.free_velocity = Vector::Zero(6 * n);
  for (int i = 0; i < n; ++i) {
    Eigen::Matrix<Real, 6, 6> block;
    for (int k = 0; k < 36; ++k) block(k / 6, k % 6) = problem.mass[36 * i + k];
    dense.inverse_mass.block<6, 6>(6 * i, 6 * i) = block.fullPivLu().inverse();
  }
  for (int k = 0; k < 6 * n; ++k) dense.free_velocity[k] = problem.free_velocity[k];
  dense.jacobian = Matrix::Zero(m, 6 * n);
  dense.offset.resize(m), dense.lower.resize(m), dense.upper.resize(m);
  for (int r = 0; r < m; ++r) {
    for (int k = 0; k < 12; ++k) {
      const int body = problem.row_body[2 * r + k / 6];
      if (body >= 0) dense.jacobian(r, 6 * body + k % 6) = problem.jacobian[12 * r + k];
    }
    dense.lower[r] = problem.lower[r];
    dense.upper[r] = problem.upper[r];
  }
  dense.effective = dense.jacobian * dense.inverse_mass * dense.jacobian.transpose();
  dense.offset = dense.jacobian * dense.free_velocity;
  for (int r = 0; r < m; ++r) {
    dense.effective(r, r) += problem.compliance[r];
    dense.offset[r] -= problem.rhs[r];
  }
  return dense;
}

// Impulses of one active set.
RowVector solve_set(const DenseProblem& dense, const std::vector<RowState>& states) {
  const int m = static_cast<int>(states.size());
  RowVector impulse = RowVector::Zero(m);
  std::array<int, kOracleMostRows> free_row{};
  int free_rows = 0;
  for (int r = 0; r < m; ++r) {
    if (states[r] == RowState::free) free_row[free_rows++] = r;
    if (states[r] == RowState::at_lower) impulse[r] = dense.lower[r];
    if (states[r] == RowState::at_upper) impulse[r] = dense.upper[r];
  }
  if (free_rows == 0) return impulse;
  const RowVector slack = dense.effective * impulse + dense.offset;
  RowMatrix matrix(free_rows, free_rows);
  RowVector right(free_rows);
  for (int i = 0; i < free_rows; ++i) {
    right[i] = -slack[free_row[i]];
    for (int j = 0; j < free_rows; ++j) matrix(i, j) = dense.effective(free_row[i], free_row[j]);
  }
  const RowVector found = matrix.ldlt().solve(right);
  for (int i = 0; i < free_rows; ++i) impulse[free_row[i]] = found[i];
  return impulse;
}

// Largest excess over a bound (times A_rr) or wrong sign or size of w.
Real find_violation(const DenseProblem& dense, const std::vector<RowState>& states,
                    const RowVector& impulse) {
  const RowVector slack = dense.effective * impulse + dense.offset;
  Real violation = 0;
  for (int r = 0; r < slack.size(); ++r) {
    if (states[r] == RowState::free) {
      const Real excess = std::max(dense.lower[r] - impulse[r], impulse[r] - dense.upper[r]);
      violation = std::max({violation, dense.effective(r, r) * excess, std::abs(slack[r])});
    } else if (dense.lower[r] < dense.upper[r]) {
      violation = std::max(violation, states[r] == RowState::at_lower ? -slack[r] : slack[r]);
    }
  }
  return violation;
}

std::vector<RowState> allowed_states(double lower, double upper) {
  if (lower == upper) return {RowState::at_lower};
  std::vector<RowState> states = {RowState::free};
  if (std::isfinite(lower)) states.push_back(RowState::at_lower);
  if (std::isfinite(upper)) states.push_back(RowState::at_upper);
  return states;
}

void check_problem(const StepProblem& problem) {
  if (problem.row_count() > kOracleMostRows) {
    throw std::invalid_argument("rows = " + std::to_string(problem.row_count()) + ", allowed: 0 to " +
                                std::to_string(kOracleMostRows));
  }
  for (const double compliance : problem.compliance) {
    if (!(compliance > 0))
      throw std::invalid_argument("compliance = " + std::to_string(compliance) + ", allowed: > 0");
  }
}

}  // namespace

OracleSolution solve_by_enumeration(const StepProblem& problem) {
  check_problem(problem);
  const DenseProblem dense = make_dense(problem);
  const int m = problem.row_count();
  std::vector<std::vector<RowState>> allowed(m);
  for (int r = 0; r < m; ++r) allowed[r] = allowed_states(problem.lower[r], problem.upper[r]);

  std::vector<std::size_t> choice(m, 0);
  std::vector<RowState> states(m);
  RowVector best;
  Real best_violation = std::numeric_limits<Real>::infinity();
  int sets = 0;
  for (bool more = true; more; ++sets) {
    for (int r = 0; r < m; ++r) states[r] = allowed[r][choice[r]];
    const RowVector impulse = solve_set(dense, states);
    const Real violation = find_violation(dense, states, impulse);
    if (violation < best_violation) best = impulse, best_violation = violation;
    int digit = 0;  // counts through all combinations like an odometer
    while (digit < m && ++choice[digit] == allowed[digit].size()) choice[digit++] = 0;
    more = digit < m;
  }

  OracleSolution solution;
  solution.sets = sets;
  solution.worst_violation_m_per_s = static_cast<double>(best_violation);
  const Vector velocity = dense.free_velocity + dense.inverse_mass * (dense.jacobian.transpose() * best);
  for (int r = 0; r < m; ++r) solution.impulse.push_back(static_cast<double>(best[r]));
  for (int k = 0; k < velocity.size(); ++k) solution.velocity.push_back(static_cast<double>(velocity[k]));
  return solution;
}

}  // namespace cleave
