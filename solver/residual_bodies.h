// What impulses make of bodies, for the judge (residual.h) alone: J^T lambda and v = v0 + M^-1 J^T lambda, in
// extended precision.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "solver/step_problem.h"

namespace cleave::judging {

// Sums run in extended precision: with a heavy body on a light one, impulses of 1e5 N s per kg cancel in w,
// and in double the judge would see its own rounding errors.
using Real = long double;
using Vector6 = Eigen::Matrix<Real, 6, 1>;
using ConstVector6 = Eigen::Map<const Eigen::Matrix<double, 6, 1>>;

// Cholesky's factor of a mass, M = L L^T, without what leading zeros of a row leave zero: of a body about its
// centre of mass, all between moving and turning.
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

// Six numbers of extended precision, each as a sum of two doubles, exact within their range: its 64 bits are
// in 53 and 11 of theirs. Every row loads the velocities of its bodies, and to load and add two doubles takes
// less time than to load one number of extended precision: a sixth of a whole look at resting rows.
class SplitVector6 {
 public:
  SplitVector6() {}
  explicit SplitVector6(const Vector6& numbers);
  // Not evaluated: it is made where it is used.
  auto sum() const { return high_.cast<Real>() + low_.cast<Real>(); }

 private:
  Eigen::Matrix<double, 6, 1> high_, low_;
};

// Of all bodies; those that are not needed have zeros for impulses, and no more. Side by side for each
// quantity: every row looks at velocities, and few at the factors, which are far larger.
struct BodyStates {
  explicit BodyStates(int bodies)
      : is_needed(bodies, 0), impulse(bodies, Vector6::Zero()), velocity(bodies), mass_factor(bodies) {}

  std::vector<char> is_needed;
  std::vector<Vector6> impulse;  // J^T lambda
  std::vector<SplitVector6> velocity;
  std::vector<MassFactor> mass_factor;
};

// Not evaluated: six numbers of extended precision take longer to store than to make anew.
inline auto jacobian_block(const StepProblem& problem, int row, int side) {
  return ConstVector6(&problem.jacobian[12 * row + 6 * side]).cast<Real>();
}

// asked: (m) 1 on rows whose bodies are needed; empty: all are.
BodyStates find_body_states(const StepProblem& problem, std::span<const double> impulse,
                            std::span<const char> asked = {});

}  // namespace cleave::judging
