#include "harness/world/body_terms.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <stdexcept>
#include <string>

namespace cleave {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// ODE pads 3-vectors to 4 and 3x3 matrices to 3x4.
Vector3d to_vector(const dReal* v) { return {v[0], v[1], v[2]}; }

Matrix3d to_matrix(const dReal* m) {
  return Eigen::Map<const Eigen::Matrix<dReal, 3, 4, Eigen::RowMajor>>(m).leftCols<3>();
}

Matrix3d cross_matrix(const Vector3d& v) {
  Matrix3d cross;
  cross << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return cross;
}

// Each of these changes what ODE does with a body's velocity, so leaving it out would solve another problem.
void require_plain_body(dBodyID body, int index) {
  const char* feature = nullptr;
  if (dBodyIsKinematic(body)) feature = "a kinematic body";
  if (!dBodyIsEnabled(body)) feature = "a disabled body";
  if (dBodyGetLinearDamping(body) != 0) feature = "linear damping";
  if (dBodyGetAngularDamping(body) != 0) feature = "angular damping";
  if (std::isfinite(dBodyGetMaxAngularSpeed(body))) feature = "a maximum angular speed";
  if (feature)
    throw std::runtime_error("body " + std::to_string(index) + ": " + feature + " is not extracted from ODE");
}

void append_body(dBodyID body, const Vector3d& gravity, double h_s, StepProblem& problem) {
  dMass mass;
  dBodyGetMass(body, &mass);
  const Matrix3d rotation = to_matrix(dBodyGetRotation(body));
  const Matrix3d inertia = rotation * to_matrix(mass.I) * rotation.transpose();
  const Vector3d omega = to_vector(dBodyGetAngularVel(body));

  Vector3d acceleration = to_vector(dBodyGetForce(body)) / mass.mass;
  if (dBodyGetGravityMode(body)) acceleration += gravity;
  Vector3d torque = to_vector(dBodyGetTorque(body));
  if (dBodyGetGyroscopicMode(body)) torque += implicit_gyroscopic_torque(inertia, omega, h_s);

  Eigen::Matrix<double, 6, 6> block = Eigen::Matrix<double, 6, 6>::Zero();
  block.topLeftCorner<3, 3>().diagonal().setConstant(mass.mass);
  // Rounding in R I R^T must not leave a block that is only nearly symmetric: solvers read either triangle.
  block.bottomRightCorner<3, 3>() = 0.5 * (inertia + inertia.transpose());
  const Vector3d linear = to_vector(dBodyGetLinearVel(body)) + h_s * acceleration;
  const Vector3d angular = omega + h_s * (inertia.inverse() * torque);

  problem.mass.insert(problem.mass.end(), block.data(), block.data() + block.size());
  problem.free_velocity.insert(problem.free_velocity.end(), linear.data(), linear.data() + 3);
  problem.free_velocity.insert(problem.free_velocity.end(), angular.data(), angular.data() + 3);
}

}  // namespace

Vector3d implicit_gyroscopic_torque(const Matrix3d& inertia, const Vector3d& omega, double h_s) {
  const Vector3d momentum = inertia * omega;
  const Vector3d next_omega = (inertia - h_s * cross_matrix(momentum)).inverse() * momentum;
  return (inertia * next_omega - momentum) / h_s;
}

void append_body_terms(const OdeWorld& world, double h_s, StepProblem& problem) {
  dVector3 gravity;
  dWorldGetGravity(world.world(), gravity);
  const auto& bodies = world.content().bodies;
  for (int i = 0; i < world.body_count(); ++i) {
    require_plain_body(bodies[i], i);
    append_body(bodies[i], to_vector(gravity), h_s, problem);
  }
}

void add_force(int body, std::span<const double, 6> force, StepProblem& problem) {
  using Block = Eigen::Matrix<double, 6, 6>;
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  const Eigen::Map<const Block> mass(&problem.mass[36 * static_cast<std::size_t>(body)]);
  const Eigen::Map<const Vector6> applied(force.data());
  Eigen::Map<Vector6>(&problem.free_velocity[6 * static_cast<std::size_t>(body)]) +=
      problem.h_s * mass.llt().solve(applied);
}

}  // namespace cleave
