// What every strategy and kernel derives from a StepProblem before it iterates: rows grouped by body pair,
// M^-1, J M^-1, the set of impulses and the diagonal of J M^-1 J^T + C along its axes. Fixed during a solve.
#pragma once

#include <span>
#include <vector>

#include "solver/impulse_set.h"
#include "solver/step_problem.h"

namespace cleave {

// A run of consecutive rows between the same two bodies; body_b is -1 for static.
struct RowGroup {
  int body_a = 0;
  int body_b = -1;
  int first_row = 0;
  int row_count = 0;
};

class PreparedStep {
 public:
  // problem must outlive this object. Buffers are kept from one problem to the next.
  void prepare(const StepProblem& problem);

  const StepProblem& problem() const { return *problem_; }
  int body_count() const { return problem_->body_count(); }
  int row_count() const { return problem_->row_count(); }
  std::span<const RowGroup> groups() const { return groups_; }
  std::span<const double> inverse_mass() const { return inverse_mass_; }  // (n, 6, 6)
  // (m, 12) rows of M^-1 J^T, laid out as the Jacobian.
  std::span<const double> mass_jacobian() const { return mass_jacobian_; }
  const ImpulseSet& set() const { return set_; }
  // (m) d_r = (J M^-1 J^T + C)_rr along the axes of the set.
  std::span<const double> diagonal() const { return diagonal_; }
  double velocity_scale() const { return velocity_scale_; }  // max(1, largest |v0|), m/s
  double least_relative_compliance() const {
    return least_relative_compliance_;
  }  // min C_r / d_r; inf without rows
  double exact_limit_m_per_s() const { return kExactLimit * velocity_scale_; }

  // v (n, 6) = v0 + M^-1 J^T lambda
  void velocity(std::span<const double> impulse, std::span<double> v) const;
  // out (m) = J v
  void jacobian_times(std::span<const double> v, std::span<double> out) const;
  // out (n, 6) += J^T x
  void add_jacobian_transpose(std::span<const double> x, std::span<double> out) const;
  // w (m) = J v + C lambda - b
  void slack(std::span<const double> v, std::span<const double> impulse, std::span<double> w) const;
  // The quantity the judge measures; impulse and w along the axes of the set.
  double residual(std::span<const double> impulse, std::span<const double> w) const {
    return set_.residual(diagonal_, impulse, w);
  }

 private:
  void turn_diagonal();

  const StepProblem* problem_ = nullptr;
  ImpulseSet set_;
  std::vector<RowGroup> groups_;
  std::vector<double> inverse_mass_, mass_jacobian_, diagonal_;
  double velocity_scale_ = 1, least_relative_compliance_ = 0;
};

}  // namespace cleave
