// The gap of a joint, whatever its kind, its own parameters and the side of the world.
#include <gtest/gtest.h>

#include "harness/world/joint_rows.h"
#include "tests/harness/ode_test_world.h"

namespace cleave {
namespace {

dJointID attached(dJointID joint, dBodyID a, dBodyID b) {
  dJointAttach(joint, a, b);
  return joint;
}

dJointID add_ball(dWorldID world, dBodyID a, dBodyID b) {
  const dJointID joint = attached(dJointCreateBall(world, nullptr), a, b);
  dJointSetBallAnchor(joint, 0, 0, 0.5);
  return joint;
}
dJointID add_hinge(dWorldID world, dBodyID a, dBodyID b) {
  const dJointID joint = attached(dJointCreateHinge(world, nullptr), a, b);
  dJointSetHingeAnchor(joint, 0, 0, 0.5);
  dJointSetHingeAxis(joint, 1, 0, 0);
  return joint;
}
dJointID add_slider(dWorldID world, dBodyID a, dBodyID b) {
  const dJointID joint = attached(dJointCreateSlider(world, nullptr), a, b);
  dJointSetSliderAxis(joint, 1, 0, 0);
  return joint;
}
dJointID add_fixed(dWorldID world, dBodyID a, dBodyID b) {
  const dJointID joint = attached(dJointCreateFixed(world, nullptr), a, b);
  dJointSetFixed(joint);
  return joint;
}

// Two bodies a metre apart, the upper one then moved by (0, 0.03, 0.04).
std::unique_ptr<OdeWorld> make_open_joint(dJointID (*add)(dWorldID, dBodyID, dBodyID), bool to_world) {
  auto world = make_world(
      [add, to_world](dWorldID w, dSpaceID space, SceneContent& content) {
        SceneBuilder builder(w, space);
        builder.add_sphere({{0, 0, 0}}, 1, 0.1);
        builder.add_sphere({{0, 0, 1}}, 1, 0.1);
        content = builder.take();
        content.joints.push_back(add(w, to_world ? nullptr : content.bodies[0], content.bodies[1]));
      },
      9.81);
  EXPECT_NEAR(joint_drift_m(*world), 0, 1e-15);
  BodyState state = world->state(1);
  state.position_m = {0, 0.03, 1.04};
  world->set_state(1, state);
  return world;
}

TEST(JointDrift, IsTheGapOfEveryKind) {
  for (const bool to_world : {false, true})
    for (const auto add : {add_ball, add_hinge, add_slider, add_fixed})
      EXPECT_NEAR(joint_drift_m(*make_open_joint(add, to_world)), 0.05, 1e-14) << to_world;
}

TEST(JointDrift, IgnoresTheJointsOwnErpAndWhereASliderMayGo) {
  const auto ball = make_open_joint(add_ball, false);
  dJointSetBallParam(ball->content().joints[0], dParamERP, 0.25);
  EXPECT_NEAR(joint_drift_m(*ball), 0.05, 1e-14);
  EXPECT_EQ(dJointGetBallParam(ball->content().joints[0], dParamERP), 0.25);
  const auto slider = make_open_joint(add_slider, false);
  BodyState state = slider->state(1);
  state.position_m = {3, 0, 1.02};
  slider->set_state(1, state);
  EXPECT_NEAR(joint_drift_m(*slider), 0.02, 1e-14);
}

TEST(JointDrift, IsThatOfTheWidestEnabledJoint) {
  EXPECT_EQ(joint_drift_m(*make_world("ladder_free", {}, 1)), 0);
  const auto chain = make_world("ladder_chain", {{"links", "4"}}, 1);
  BodyState state = chain->state(3);
  state.position_m[0] += 0.2;
  chain->set_state(3, state);
  EXPECT_NEAR(joint_drift_m(*chain), 0.2, 1e-14);
  dJointDisable(chain->content().joints[3]);
  EXPECT_NEAR(joint_drift_m(*chain), 0, 1e-14);
}

}  // namespace
}  // namespace cleave
