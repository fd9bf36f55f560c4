// Types of ODE's joints, and what scenes set on the axis of a hinge or slider: limits and a motor.
#pragma once

#include <ode/ode.h>

namespace cleave {

// As errors call it: "universal".
const char* joint_type_name(dJointType type);

// Gives a joint the stops, motor, bounce and fudge factor of another one of its type, which a scene may have
// changed while it ran. Nothing for a type but hinge and slider. ERP and CFM of the axis stay.
void copy_axis(dJointID from, dJointID to);

}  // namespace cleave
