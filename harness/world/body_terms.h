// Mass blocks and free velocities of the bodies of an ODE world.
//
// ODE keeps a body's origin at its centre of mass, so its world-frame mass block is diag(m 1, R I_body R^T).
// The free velocity is what the body would have after the step without any constraint,
//     v0 = u + h M^-1 (force, torque),
// with gravity (where the body's gravity mode is on), the force and torque accumulated on the body and, where
// its gyroscopic mode is on, the torque below.
#pragma once

#include <Eigen/Core>
#include <span>

#include "harness/world/ode_world.h"
#include "solver/step_problem.h"

namespace cleave {

// ODE's gyroscopic torque, N m: Euler's equation d(I w)/dt = 0 stepped implicitly in w with the angular
// momentum L = I w of the start of the step held fixed (Lacoursiere, Stabilizing gyroscopic forces in rigid
// multibody simulations, 2006):
//     I (w' - w) / h + w' x L = 0   <=>   (I - h [L]x) w' = L   <=>   torque = (I (I - h [L]x)^-1 - 1) L / h
// The matrix is never singular: its determinant is det(I) + h^2 L^T I L.
// inertia: world frame, kg m^2; omega: rad/s.
Eigen::Vector3d implicit_gyroscopic_torque(const Eigen::Matrix3d& inertia, const Eigen::Vector3d& omega,
                                           double h_s);

// Appends mass and free_velocity of every body of the world to the problem. Throws std::runtime_error naming
// the body for what is not extracted: kinematic or disabled bodies, damping, a limit on angular speed.
void append_body_terms(const OdeWorld& world, double h_s, StepProblem& problem);

// Adds h M^-1 (force, torque) to the free velocity of a body of the problem: force in N, torque in N m.
void add_force(int body, std::span<const double, 6> force, StepProblem& problem);

}  // namespace cleave
