// The friction cone of one contact, K = { (n, t): |t| <= mu n }, with n the normal impulse and t the one or two tangential
// ones. Vectors of a contact have three entries; the last is zero where there is one tangent.
//
// K is no product of intervals, so that "the nearest point of the set" and the residual are those of the whole contact, with
// one d (m/s per N s) for its rows. (The judge has its own, residual.cpp.)
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <span>

namespace cleave {

struct FrictionCone {
  int first_row = 0;  // the normal; tangents follow
  int row_count = 3;  // 2 or 3
  double mu = 0;
  bool coulomb = false;  // whether w_n + mu |w_t| takes the place of w_n

  Eigen::Vector3d load(std::span<const double> x) const {
    const double* row = x.data() + first_row;
    return {row[0], row[1], row_count == 3 ? row[2] : 0.0};
  }
  void store(const Eigen::Vector3d& value, std::span<double> x) const {
    for (int k = 0; k < row_count; ++k) x[first_row + k] = value[k];
  }
};

// |t|. (Not by std::hypot: impulses and velocities are far from where squares overflow, and it takes longer than all the
// rest.)
inline double tangential(const Eigen::Vector3d& x) { return std::sqrt(x[1] * x[1] + x[2] * x[2]); }

// The nearest point of K: y itself inside, zero where mu |t| <= -n, else on the surface,
// n' = (n + mu |t|) / (1 + mu^2), t' = mu n' t / |t|.
Eigen::Vector3d project_on_cone(const Eigen::Vector3d& y, double mu);

// d (lambda - P(lambda - w / d)), m/s: zero where the contact's conditions hold.
Eigen::Vector3d cone_residual(double mu, double d, const Eigen::Vector3d& lambda, const Eigen::Vector3d& w);

// w of Coulomb's law as the cone's: with mu |w_t| added to the normal (de Saxce and Feng 1998).
Eigen::Vector3d shifted_slack(double mu, const Eigen::Vector3d& w);

}  // namespace cleave
