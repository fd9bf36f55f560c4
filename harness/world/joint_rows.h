// Rows of the permanent joints of a world, as ODE builds them (ode_joint.h).
//
// Rows of a joint with the static environment are those of its one body, whichever side of dJointAttach it
// was on. All rows are bilateral by their kind, that of a stop or motor with bounds: h times those of the
// force. What a motor at its stop pushes with goes into the free velocities.
#pragma once

#include "harness/world/contact_memory.h"
#include "harness/world/ode_world.h"
#include "solver/step_problem.h"

namespace cleave {

// Appends the rows of every enabled joint of world.content().joints in that order, with the joint's index as
// row_constraint. erp, cfm: of the step, for joints without their own. problem: has its bodies
// (body_terms.h). Throws std::runtime_error naming the type for any other joint type, and for a joint on a
// body that content().joints does not list.
void append_joint_rows(const OdeWorld& world, double h_s, double erp, double cfm, const ContactMemory& memory,
                       StepProblem& problem);

// The widest gap of an enabled joint: the norm of ODE's position error over the permanent rows that hold
// points together (not those that hold directions), m. 0 without joints.
double joint_drift_m(const OdeWorld& world);

}  // namespace cleave
