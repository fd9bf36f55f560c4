#include "solver/cone.h"

namespace cleave {

Eigen::Vector3d project_on_cone(const Eigen::Vector3d& y, double mu) {
  const double t = tangential(y);
  if (t <= mu * y[0]) return y;
  if (mu * t <= -y[0]) return Eigen::Vector3d::Zero();
  const double normal = (y[0] + mu * t) / (1 + mu * mu);
  return {normal, mu * normal * y[1] / t, mu * normal * y[2] / t};
}

// As w + (y - P(y)) with y = d lambda - w, where y - P(y) is zero or lies on the surface of the polar cone,
// along (-mu, t / |t|): no digits are lost to the difference of two large impulses.
Eigen::Vector3d cone_residual(double mu, double d, const Eigen::Vector3d& lambda, const Eigen::Vector3d& w) {
  const Eigen::Vector3d y = d * lambda - w;
  const double t = tangential(y);
  if (t <= mu * y[0]) return w;
  if (mu * t <= -y[0]) return d * lambda;
  const double apart = (t - mu * y[0]) / (1 + mu * mu);
  return {w[0] - mu * apart, w[1] + apart * y[1] / t, w[2] + apart * y[2] / t};
}

Eigen::Vector3d shifted_slack(double mu, const Eigen::Vector3d& w) {
  return {w[0] + mu * tangential(w), w[1], w[2]};
}

}  // namespace cleave
