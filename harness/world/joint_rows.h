// Rows of ODE's permanent joints: ball (3 rows), hinge (5), slider (5) and fixed (6).
//
// Jacobian, error and row order are ODE's own: the rows come from the functions dWorldStep calls, because
// ODE's public interface does not give a joint's rest pose (the relative rotation a fixed joint or a slider
// holds). Rows of a joint with the static environment are those of its one body, whichever side of
// dJointAttach it was on.
//
// A ball or fixed joint has an erp and a cfm of its own, which ODE copies from the world when the joint is
// created. One that still equals dWorldGetERP (dWorldGetCFM) counts as not set and takes the step's value;
// one set by dJointSetBallParam or dJointSetFixedParam is kept. A world's ERP and CFM must therefore not be
// changed after its joints exist. As in ODE, the own values of a fixed joint govern its three position rows
// only.
#pragma once

#include "harness/world/contact_memory.h"
#include "harness/world/ode_world.h"
#include "solver/step_problem.h"

namespace cleave {

// Appends the rows of every enabled joint of world.content().joints in that order, with the joint's index as
// row_constraint. erp, cfm: of the step, for joints without their own. Throws std::runtime_error naming the
// type and the feature for any other joint type, a limit, a motor, and for a joint on a body that
// content().joints does not list.
void append_joint_rows(const OdeWorld& world, double h_s, double erp, double cfm, const ContactMemory& memory,
                       StepProblem& problem);

// The widest gap of an enabled joint: the norm of ODE's position error over the rows that hold points
// together (not those that hold directions), m. 0 without joints.
double joint_drift_m(const OdeWorld& world);

}  // namespace cleave
