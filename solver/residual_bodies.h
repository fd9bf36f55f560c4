// What impulses make of bodies, for the judge (residual.h) alone: J^T lambda and v = v0 + M^-1 J^T lambda.
// All is there in two kinds of numbers: Extended, by which the judge decides, and double, for a first look.
#pragma once

#include <Eigen/Core>
#include <span>
#include <type_traits>
#include <vector>

#include "solver/step_problem.h"

namespace cleave::judging {

// Extended precision: with a heavy body on a light one, impulses of 1e5 N s per kg cancel in w, and in double
// the judge would see its own rounding errors.
using Extended = long double;

template <class Real>
using Vector6 = Eigen::Matrix<Real, 6, 1>;
using ConstVector6 = Eigen::Map<const Eigen::Matrix<double, 6, 1>>;

// Cholesky's factor of a mass, M = L L^T, without what leading zeros of a row leave zero: of a body about its
// centre of mass, all between moving and turning.
template <class Real>
class MassFactor {
 public:
  MassFactor() {}                    // of nothing yet; its numbers are not worth setting to 0
  void compute(const double* mass);  // (6, 6)

  // M^-1 f; NaN where M is not positive definite.
  Vector6<Real> solve(Vector6<Real> f) const;

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
  explicit SplitVector6(const Vector6<Extended>& numbers);
  // Not evaluated: it is made where it is used.
  auto sum() const { return high_.cast<Extended>() + low_.cast<Extended>(); }

 private:
  Vector6<double> high_, low_;
};

// Six doubles, read as those are.
class WholeVector6 {
 public:
  WholeVector6() {}
  explicit WholeVector6(const Vector6<double>& numbers) : numbers_(numbers) {}
  const Vector6<double>& sum() const { return numbers_; }

 private:
  Vector6<double> numbers_;
};

// Of all bodies; those that are not needed have zeros for impulses, and no more. Side by side for each
// quantity: every row looks at velocities, and few at the factors, which are far larger.
template <class Real>
struct BodyStates {
  using Velocity = std::conditional_t<std::is_same_v<Real, double>, WholeVector6, SplitVector6>;

  explicit BodyStates(int bodies)
      : is_needed(bodies, 0), impulse(bodies, Vector6<Real>::Zero()), velocity(bodies), mass_factor(bodies) {}

  std::vector<char> is_needed;
  std::vector<Vector6<Real>> impulse;  // J^T lambda
  std::vector<Velocity> velocity;
  std::vector<MassFactor<Real>> mass_factor;
};

// Not evaluated: six numbers of extended precision take longer to store than to make anew.
template <class Real>
auto jacobian_block(const StepProblem& problem, int row, int side) {
  return ConstVector6(&problem.jacobian[12 * row + 6 * side]).cast<Real>();
}

// asked: (m) 1 on rows whose bodies are needed; empty: all are.
template <class Real>
BodyStates<Real> find_body_states(const StepProblem& problem, std::span<const double> impulse,
                                  std::span<const char> asked = {});

}  // namespace cleave::judging
