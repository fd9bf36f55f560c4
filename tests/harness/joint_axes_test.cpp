// Names of ODE's joint types; a world that is built anew has what a scene set on its joints meanwhile.
#include "harness/world/joint_axes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/harness/joined_bodies.h"

namespace cleave {
namespace {

// ODE's own list of types; a joint type that is new there has a row here, or the program does not compile.
TEST(JointAxes, EveryTypeHasItsOwnName) {
  std::vector<std::string> names;
  for (int type = dJointTypeNone; type <= dJointTypeTransmission; ++type)
    names.push_back(joint_type_name(static_cast<dJointType>(type)));
  EXPECT_EQ(names[dJointTypeHinge], "hinge");
  EXPECT_EQ(names[dJointTypeFixed], "fixed");
  EXPECT_EQ(names[dJointTypePU], "prismatic-universal");
  EXPECT_EQ(names[dJointTypeTransmission], "transmission");
  std::ranges::sort(names);
  EXPECT_EQ(std::ranges::adjacent_find(names), names.end());
}

struct AxisKind {
  const JointCase* joint;
  void (*set)(dJointID joint, int parameter, dReal value);
  dReal (*get)(dJointID joint, int parameter);
};

TEST(JointAxes, ARebuiltWorldHasWhatWasSetSince) {
  for (const AxisKind& kind : {AxisKind{&kJointCases[1], dJointSetHingeParam, dJointGetHingeParam},
                               AxisKind{&kJointCases[2], dJointSetSliderParam, dJointGetSliderParam}}) {
    const auto world = make_joined_bodies(*kind.joint, Attachment::two_bodies, 1, true, {});
    const std::pair<int, double> values[] = {{dParamLoStop, -0.5}, {dParamHiStop, 0.25},
                                             {dParamFMax, 7},      {dParamVel, -3},
                                             {dParamBounce, 0.5},  {dParamFudgeFactor, 0.75}};
    for (const auto& [parameter, value] : values) kind.set(world->content().joints[0], parameter, value);
    const auto rebuilt = world->rebuilt(0.2, 1e-5);
    for (const auto& [parameter, value] : values)
      EXPECT_EQ(kind.get(rebuilt->content().joints[0], parameter), value)
          << kind.joint->name << " " << parameter;
  }
}

}  // namespace
}  // namespace cleave
