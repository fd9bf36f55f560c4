// The friction cone of one contact, K = { (n, t): |t| <= mu n }, with n the normal impulse and t the one or
// two tangential ones. Vectors of a contact have three entries; the last is zero where there is one tangent.
//
// K is no product of intervals, so that "the nearest point of the set" and the residual are those of the
// whole contact, with one d (m/s per N s) for its rows. (The judge has its own, residual_rows.cpp.)
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <span>

#include "solver/friction_cone.h"

namespace cleave {

// The three entries of a cone's contact, of x (m) and into it.
inline Eigen::Vector3d load_contact(const FrictionCone& cone, std::span<const double> x) {
  const double* row = x.data() + cone.first_row;
  return {row[0], row[1], cone.row_count == 3 ? row[2] : 0.0};
}
inline void store_contact(const FrictionCone& cone, const Eigen::Vector3d& value, std::span<double> x) {
  for (int k = 0; k < cone.row_count; ++k) x[cone.first_row + k] = value[k];
}

// |t|. (Not by std::hypot: impulses and velocities are far from where squares overflow, and it takes longer
// than all the rest.)
inline double tangential(const Eigen::Vector3d& x) { return std::sqrt(x[1] * x[1] + x[2] * x[2]); }

// The nearest point of K: y itself inside, zero where mu |t| <= -n, else on the surface,
// n' = (n + mu |t|) / (1 + mu^2), t' = mu n' t / |t|.
Eigen::Vector3d project_on_cone(const Eigen::Vector3d& y, double mu);

// d (lambda - P(lambda - w / d)), m/s: zero where the contact's conditions hold.
Eigen::Vector3d cone_residual(double mu, double d, const Eigen::Vector3d& lambda, const Eigen::Vector3d& w);

// w of Coulomb's law as the cone's: with mu |w_t| added to the normal (de Saxce and Feng 1998).
Eigen::Vector3d shifted_slack(double mu, const Eigen::Vector3d& w);

}  // namespace cleave
