#include "solver/prepared_step.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace cleave {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

}  // namespace

void PreparedStep::prepare(const StepProblem& problem) {
  problem_ = &problem;
  const int n = body_count(), m = row_count();
  groups_.clear();
  for (int r = 0; r < m; ++r) {
    const int a = problem.row_body[2 * r], b = problem.row_body[2 * r + 1];
    if (groups_.empty() || groups_.back().body_a != a || groups_.back().body_b != b)
      groups_.push_back({a, b, r, 0});
    ++groups_.back().row_count;
  }
  inverse_mass_.resize(36 * static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) {
    const Eigen::Map<const Matrix6> mass(problem.mass.data() + 36 * i);
    Eigen::Map<Matrix6>(inverse_mass_.data() + 36 * i) = mass.llt().solve(Matrix6::Identity());
  }
  mass_jacobian_.assign(12 * static_cast<std::size_t>(m), 0.0);
  diagonal_.resize(m);
  for (int r = 0; r < m; ++r) {
    double d = problem.compliance[r];
    for (int side = 0; side < 2; ++side) {
      const int body = problem.row_body[2 * r + side];
      if (body < 0) continue;
      const Eigen::Map<const Vector6> j(problem.jacobian.data() + 12 * r + 6 * side);
      Eigen::Map<Vector6> mj(mass_jacobian_.data() + 12 * r + 6 * side);
      mj = Eigen::Map<const Matrix6>(inverse_mass_.data() + 36 * body) * j;
      d += j.dot(mj);
    }
    diagonal_[r] = d > 0 ? d : 1;  // a row of zeros constrains nothing
  }
  set_.bind(problem);
  turn_diagonal();
  least_relative_compliance_ = std::numeric_limits<double>::infinity();
  for (int r = 0; r < m; ++r) {
    least_relative_compliance_ = std::min(least_relative_compliance_, problem.compliance[r] / diagonal_[r]);
  }
  velocity_scale_ = 1;
  for (double v : problem.free_velocity) velocity_scale_ = std::max(velocity_scale_, std::abs(v));
}

// On the rows of a turned box, d_k = f^T (J M^-1 J^T + C) f along each axis f.
void PreparedStep::turn_diagonal() {
  for (const WeightBlock& block : set_.axes()) {
    for (int k = 0; k < block.row_count; ++k) {
      const double* axis = block.basis.data() + block.row_count * k;
      double j[12] = {}, mj[12] = {}, d = 0;
      for (int i = 0; i < block.row_count; ++i) {
        const int row = block.first_row + i;
        d += axis[i] * axis[i] * problem_->compliance[row];
        for (int c = 0; c < 12; ++c) {
          j[c] += axis[i] * problem_->jacobian[12 * row + c];
          mj[c] += axis[i] * mass_jacobian_[12 * row + c];
        }
      }
      for (int c = 0; c < 12; ++c) d += j[c] * mj[c];
      diagonal_[block.first_row + k] = d > 0 ? d : 1;
    }
  }
}

void PreparedStep::velocity(std::span<const double> impulse, std::span<double> v) const {
  std::copy(problem_->free_velocity.begin(), problem_->free_velocity.end(), v.begin());
  for (const RowGroup& g : groups_) {
    double a[6] = {}, b[6] = {};
    for (int r = g.first_row; r < g.first_row + g.row_count; ++r) {
      const double* mj = mass_jacobian_.data() + 12 * r;
      for (int c = 0; c < 6; ++c) a[c] += mj[c] * impulse[r], b[c] += mj[6 + c] * impulse[r];
    }
    for (int c = 0; c < 6; ++c) v[6 * g.body_a + c] += a[c];
    if (g.body_b < 0) continue;
    for (int c = 0; c < 6; ++c) v[6 * g.body_b + c] += b[c];
  }
}

void PreparedStep::jacobian_times(std::span<const double> v, std::span<double> out) const {
  for (const RowGroup& g : groups_) {
    double both[12] = {};
    std::copy_n(v.data() + 6 * g.body_a, 6, both);
    if (g.body_b >= 0) std::copy_n(v.data() + 6 * g.body_b, 6, both + 6);
    for (int r = g.first_row; r < g.first_row + g.row_count; ++r) {
      const double* j = problem_->jacobian.data() + 12 * r;
      double sum[4] = {};
      for (int c = 0; c < 12; c += 4) {
        for (int k = 0; k < 4; ++k) sum[k] += j[c + k] * both[c + k];
      }
      out[r] = (sum[0] + sum[1]) + (sum[2] + sum[3]);
    }
  }
}

void PreparedStep::add_jacobian_transpose(std::span<const double> x, std::span<double> out) const {
  for (const RowGroup& g : groups_) {
    double sum[12] = {};
    for (int r = g.first_row; r < g.first_row + g.row_count; ++r) {
      const double* j = problem_->jacobian.data() + 12 * r;
      for (int c = 0; c < 12; ++c) sum[c] += j[c] * x[r];
    }
    for (int c = 0; c < 6; ++c) out[6 * g.body_a + c] += sum[c];
    if (g.body_b < 0) continue;
    for (int c = 0; c < 6; ++c) out[6 * g.body_b + c] += sum[6 + c];
  }
}

void PreparedStep::slack(std::span<const double> v, std::span<const double> impulse,
                         std::span<double> w) const {
  jacobian_times(v, w);
  for (int r = 0; r < row_count(); ++r) w[r] += problem_->compliance[r] * impulse[r] - problem_->rhs[r];
}

}  // namespace cleave
