#include "harness/world/joint_axes.h"

#include <algorithm>
#include <iterator>
#include <limits>

namespace cleave {
namespace {

using Getter = dReal (*)(dJointID joint, int parameter);

struct TypeAxes {
  dJointType type;
  const char* name;
  int axes;       // parameter groups
  Getter getter;  // null without axes
};

constexpr TypeAxes kTypes[] = {
    {dJointTypeNone, "unknown", 0, nullptr},
    {dJointTypeBall, "ball", 0, nullptr},
    {dJointTypeHinge, "hinge", 1, dJointGetHingeParam},
    {dJointTypeSlider, "slider", 1, dJointGetSliderParam},
    {dJointTypeContact, "contact", 0, nullptr},
    {dJointTypeUniversal, "universal", 2, dJointGetUniversalParam},
    {dJointTypeHinge2, "hinge2", 2, dJointGetHinge2Param},
    {dJointTypeFixed, "fixed", 0, nullptr},
    {dJointTypeNull, "null", 0, nullptr},
    {dJointTypeAMotor, "angular motor", 3, dJointGetAMotorParam},
    {dJointTypeLMotor, "linear motor", 3, dJointGetLMotorParam},
    // Its three motors have setters and no getters.
    {dJointTypePlane2D, "plane2d", 0, nullptr},
    {dJointTypePR, "prismatic-rotoide", 2, dJointGetPRParam},
    {dJointTypePU, "prismatic-universal", 3, dJointGetPUParam},
    {dJointTypePiston, "piston", 2, dJointGetPistonParam},
    {dJointTypeDBall, "double ball", 0, nullptr},
    {dJointTypeDHinge, "double hinge", 0, nullptr},
    {dJointTypeTransmission, "transmission", 0, nullptr},
};
static_assert(std::size(kTypes) == dJointTypeTransmission + 1);

const TypeAxes& row_of(dJointType type) { return *std::ranges::find(kTypes, type, &TypeAxes::type); }

// A parameter of every group, and what ODE gives a new joint.
struct AxisParameter {
  int parameter;
  const char* feature;
  double (*unset)(dWorldID world);
};

constexpr double kInfinity = std::numeric_limits<double>::infinity();

constexpr AxisParameter kParameters[] = {
    {dParamLoStop, "limit", [](dWorldID) { return -kInfinity; }},
    {dParamHiStop, "limit", [](dWorldID) { return kInfinity; }},
    {dParamFMax, "motor", [](dWorldID) { return 0.0; }},
    {dParamVel, "motor", [](dWorldID) { return 0.0; }},
    {dParamFudgeFactor, "fudge factor", [](dWorldID) { return 1.0; }},
    {dParamBounce, "bounce", [](dWorldID) { return 0.0; }},
    {dParamCFM, "motor cfm", [](dWorldID world) { return static_cast<double>(dWorldGetCFM(world)); }},
    {dParamStopERP, "stop erp", [](dWorldID world) { return static_cast<double>(dWorldGetERP(world)); }},
    {dParamStopCFM, "stop cfm", [](dWorldID world) { return static_cast<double>(dWorldGetCFM(world)); }},
};

}  // namespace

const char* joint_type_name(dJointType type) { return row_of(type).name; }

int axis_count(dJointType type) { return row_of(type).axes; }

std::string find_axis_feature(dWorldID world, dJointID joint) {
  const TypeAxes& row = row_of(dJointGetType(joint));
  for (int axis = 0; axis < row.axes; ++axis)
    for (const AxisParameter& own : kParameters)
      if (row.getter(joint, axis * dParamGroup + own.parameter) != own.unset(world))
        return std::string(own.feature) + " on axis " + std::to_string(axis + 1);
  return "";
}

}  // namespace cleave
