// Limits and motors of ODE's joints. An axis of a joint has a parameter group: dParamLoStop, dParamLoStop2
// and dParamLoStop3 are the low stops of its first, second and third. A reader of the first group alone would
// lose what the others say.
#pragma once

#include <ode/ode.h>

#include <string>

namespace cleave {

// As errors call it: "universal".
const char* joint_type_name(dJointType type);

// How many axes of a joint type can have limits and motors, one parameter group each.
int axis_count(dJointType type);

// What is set on any axis of the joint, in words ("motor on axis 2"); empty: nothing but what ODE gives a new
// joint. An erp or cfm of a stop counts as set where it is not dWorldGetERP
// (dWorldGetCFM).
std::string find_axis_feature(dWorldID world, dJointID joint);

}  // namespace cleave
