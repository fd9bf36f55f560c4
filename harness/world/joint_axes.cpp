#include "harness/world/joint_axes.h"

#include <iterator>

namespace cleave {
namespace {

// By dJointType.
constexpr const char* kTypeNames[] = {
    "unknown",
    "ball",
    "hinge",
    "slider",
    "contact",
    "universal",
    "hinge2",
    "fixed",
    "null",
    "angular motor",
    "linear motor",
    "plane2d",
    "prismatic-rotoide",
    "prismatic-universal",
    "piston",
    "double ball",
    "double hinge",
    "transmission",
};
static_assert(std::size(kTypeNames) == dJointTypeTransmission + 1);

constexpr int kDriven[] = {dParamLoStop, dParamHiStop, dParamFMax,
                           dParamVel,    dParamBounce, dParamFudgeFactor};

}  // namespace

const char* joint_type_name(dJointType type) { return kTypeNames[type]; }

void copy_axis(dJointID from, dJointID to) {
  const dJointType type = dJointGetType(from);
  for (const int parameter : kDriven) {
    if (type == dJointTypeHinge) dJointSetHingeParam(to, parameter, dJointGetHingeParam(from, parameter));
    if (type == dJointTypeSlider) dJointSetSliderParam(to, parameter, dJointGetSliderParam(from, parameter));
  }
}

}  // namespace cleave
