// From ODE's joints and contact points to a StepProblem: the one place that knows ODE's constraint data.
//
// Rows are ordered joints first, in creation order, then contact points in the order given (that of
// OdeWorld::collide); within a contact normal, t1, t2 with the tangents of ODE's dPlaneSpace(normal).
// row_constraint is the joint's index in SceneContent::joints, or the number of joints + the contact's index.
// For erp, cfm and step h:
//     C = cfm / h,   joints: b = (erp / h) * position error,
//     normal: b = min((erp / h) * max(depth - layer, 0), v_max),   friction: b = 0
// with ODE's contact surface layer and largest correcting velocity (0 and infinite unless the world sets
// them). Joint kinds: ball (3 rows), hinge (5), slider (5), fixed (6), as ODE builds them; see joint_rows.h
// for joints with an erp or cfm of their own. Friction rows that could carry nothing (model none, mu = 0,
// force 0) are not built.
#pragma once

#include <span>

#include "harness/world/contact_memory.h"
#include "harness/world/ode_world.h"
#include "solver/step_problem.h"

namespace cleave {

// Friction models (--friction); see harness/experiment/friction.h.
//   none           one row a contact
//   constant       bound = h * friction_force_n
//   box            bound = mu * predicted normal impulse (matched contact of the previous step, then
//                  bound_sweeps of Gauss-Seidel with moving bounds), then frozen: a true MLCP, the same for
//                  every solver
//   box-converged  outer fixed point on the bounds to 1e-6 relative or a stated cap; the mismatch is reported
//   cone, coulomb  no bounds: the contacts' sets (StepProblem::contact_set)
enum class FrictionModel { none, constant, box, box_converged, cone, coulomb };

inline constexpr int kBoundSweeps = 5;

struct ExtractOptions {
  double h_s = 1.0 / 60;  // > 0
  double erp = 0.2;       // >= 0
  double cfm = 1e-5;      // >= 0, s/kg for linear rows
  FrictionModel friction = FrictionModel::box;
  double mu = 0.5;                  // >= 0
  double friction_force_n = 0;      // >= 0, of `constant`
  int bound_sweeps = kBoundSweeps;  // >= 0, of `box` and `box_converged`
};

// Builds the rows. Friction bounds of all models with a coefficient are left at +-mu * warm normal impulse;
// friction.h sets what they may carry. warm_impulse comes from memory (zero where nothing matched). Throws
// std::invalid_argument naming an option outside its range, and std::runtime_error naming a joint type
// or body setting of the world that is not extracted; none is ever dropped.
StepProblem extract(const OdeWorld& world, std::span<const ContactPoint> contacts,
                    const ExtractOptions& options, const ContactMemory& memory);

}  // namespace cleave
