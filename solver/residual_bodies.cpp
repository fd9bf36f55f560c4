#include "solver/residual_bodies.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cleave::judging {

template <class Real>
void MassFactor<Real>::compute(const double* mass) {
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

template <class Real>
Vector6<Real> MassFactor<Real>::solve(Vector6<Real> f) const {
  if (!is_positive_) return Vector6<Real>::Constant(std::numeric_limits<Real>::quiet_NaN());
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

template class MassFactor<double>;
template class MassFactor<Extended>;

SplitVector6::SplitVector6(const Vector6<Extended>& numbers) : high_(numbers.cast<double>()) {
  for (int k = 0; k < 6; ++k)
    low_[k] = std::isfinite(high_[k]) ? static_cast<double>(numbers[k] - high_[k]) : 0;
}

namespace {

void mark_needed(const StepProblem& problem, std::span<const char> asked, std::span<char> is_needed) {
  if (asked.empty()) std::ranges::fill(is_needed, 1);
  for (int r = 0; r < static_cast<int>(asked.size()); ++r)
    for (const int body : {problem.row_body[2 * r], problem.row_body[2 * r + 1]})
      if (body >= 0 && asked[r]) is_needed[body] = 1;
}

// sum += J^T lambda of `count` rows, of the body on one side of all of them. Six sums stay in registers: to
// store and load numbers of extended precision takes several times as long as to add them.
template <class Real>
void add_impulses(const double* jacobian, const double* impulse, int count, Vector6<Real>& sum) {
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

}  // namespace

template <class Real>
BodyStates<Real> find_body_states(const StepProblem& problem, std::span<const double> impulse,
                                  std::span<const char> asked) {
  BodyStates<Real> bodies(problem.body_count());
  mark_needed(problem, asked, bodies.is_needed);
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
    const Vector6<Real> velocity = ConstVector6(&problem.free_velocity[6 * i]).cast<Real>() +
                                   bodies.mass_factor[i].solve(bodies.impulse[i]);
    bodies.velocity[i] = typename BodyStates<Real>::Velocity(velocity);
  }
  return bodies;
}

template BodyStates<double> find_body_states<double>(const StepProblem&, std::span<const double>,
                                                     std::span<const char>);
template BodyStates<Extended> find_body_states<Extended>(const StepProblem&, std::span<const double>,
                                                         std::span<const char>);

}  // namespace cleave::judging
