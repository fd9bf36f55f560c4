// The scenes of the stability ladder hold what the closed forms of scripts/cleave_scripts/ladder/rungs.py
// rely on.
#include <gtest/gtest.h>

#include "scene_world.h"

namespace cleave {
namespace {

double mass_kg(dBodyID body) {
  dMass mass;
  dBodyGetMass(body, &mass);
  return mass.mass;
}

std::vector<double> masses(const std::string& scene, const std::map<std::string, std::string>& given) {
  SceneWorld world(scene_named(scene), given);
  std::vector<double> values;
  for (const dBodyID body : world.content().bodies) values.push_back(mass_kg(body));
  return values;
}

TEST(LadderScenes, MassesStandInTheirOrderFromTheGroundUp) {
  EXPECT_EQ(masses("ladder_stack", {{"boxes", "3"}}), (std::vector<double>{1, 1, 1}));
  EXPECT_EQ(masses("ladder_heavy_top", {{"boxes", "2"}, {"mass-ratio", "50"}}),
            (std::vector<double>{1, 1, 50}));
  EXPECT_EQ(masses("ladder_alternating", {{"boxes", "5"}, {"mass-ratio", "8"}}),
            (std::vector<double>{1, 8, 1, 8, 1}));
  EXPECT_EQ(masses("ladder_chain", {{"links", "3"}, {"mass-ratio", "9"}}), (std::vector<double>{1, 1, 9}));
}

TEST(LadderScenes, EveryInterfaceOfAStackHasFourContactsAPairOfShapes) {
  for (const int copies : {1, 2, 3}) {
    SceneWorld world(scene_named("ladder_stack"), {{"boxes", "6"}, {"copies", std::to_string(copies)}});
    const SceneWorld::Contacts contacts = world.collide();
    EXPECT_EQ(contacts.between_bodies, 5 * 4 * copies * copies);
    EXPECT_EQ(contacts.all - contacts.between_bodies, 4 * copies);
    EXPECT_NEAR(dBodyGetPosition(world.content().bodies[5])[2], 5.5, 1e-6);
    EXPECT_NEAR(mass_kg(world.content().bodies[0]), 1, 1e-15);
  }
}

TEST(LadderScenes, OverlapUpToTheSurfaceLayerIsLeftAlone) {
  SceneWorld world(scene_named("ladder_stack"), {});
  const double layer_m = dWorldGetContactSurfaceLayer(dBodyGetWorld(world.content().bodies[0]));
  EXPECT_LT(world.collide().largest_depth_m, layer_m);
  EXPECT_LE(layer_m, 1e-6);
}

TEST(LadderScenes, HowTheBoxesTouchIsAnOptionOfEveryStack) {
  for (const std::string scene :
       {"ladder_stack", "ladder_heavy_top", "ladder_alternating", "ladder_incline"}) {
    SceneWorld world(scene_named(scene),
                     {{"boxes", "4"}, {"overlap-m", "1e-6"}, {"layer-m", "5e-7"}, {"offset-m", "0.01"}});
    const std::vector<dBodyID>& bodies = world.content().bodies;
    EXPECT_EQ(dWorldGetContactSurfaceLayer(dBodyGetWorld(bodies[0])), 5e-7) << scene;
    EXPECT_NEAR(world.collide().largest_depth_m, 1e-6, 1e-9) << scene;
    const dReal* rotation = dBodyGetRotation(bodies[0]);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      dVector3 local;
      dMultiply1_331(local, rotation, dBodyGetPosition(bodies[i]));
      EXPECT_NEAR(std::hypot(local[0], local[1]), 0.01, 1e-12) << scene << ' ' << i;
      EXPECT_NEAR(local[2], 0.5 - 1e-6 + static_cast<double>(i) * (1 - 1e-6), 1e-12) << scene << ' ' << i;
      if (i == 0) continue;
      dVector3 before;
      dMultiply1_331(before, rotation, dBodyGetPosition(bodies[i - 1]));
      EXPECT_GT(std::hypot(local[0] - before[0], local[1] - before[1]), 0.01) << scene << ' ' << i;
    }
  }
}

TEST(LadderIncline, TheBoxLiesFlatOnThePlane) {
  for (const std::string angle : {"0", "15", "80"}) {
    SceneWorld world(scene_named("ladder_incline"), {{"angle", angle}, {"boxes", "2"}});
    const SceneWorld::Contacts contacts = world.collide();
    EXPECT_EQ(contacts.all, 8) << angle;
    EXPECT_NEAR(contacts.largest_depth_m, 1e-7, 1e-9) << angle;
    const double up = std::cos(std::stod(angle) * std::acos(-1.0) / 180);
    EXPECT_NEAR(dBodyGetPosition(world.content().bodies[1])[2], 1.5 * up, 1e-6) << angle;
  }
}

TEST(LadderChain, HangsFromTheWorldInAStraightLine) {
  for (const std::string angle : {"0", "30"}) {
    SceneWorld world(scene_named("ladder_chain"), {{"links", "20"}, {"angle", angle}});
    const SceneContent& content = world.content();
    ASSERT_EQ(content.joints.size(), 20u);
    EXPECT_EQ(dJointGetBody(content.joints[0], 1), nullptr);
    EXPECT_EQ(world.collide().all, 0);
    const dReal *first = dBodyGetPosition(content.bodies[0]), *last = dBodyGetPosition(content.bodies[19]);
    EXPECT_NEAR(first[2] - last[2], 19 * 0.3 * std::cos(std::stod(angle) * std::acos(-1.0) / 180), 1e-12);
    if (angle == "0") {
      EXPECT_NEAR(last[2], 1.15, 1e-12);
    }
  }
}

// Such a ring of n links moves in n - 2 directions, where counting rows leaves 6 n - 5 (n + 1) = n - 5: three
// rows say again what others say.
TEST(LadderLoop, IsClosedByHingesWithParallelAxesAlongNoAxisOfTheWorld) {
  for (const int links : {3, 4, 7}) {
    SceneWorld world(scene_named("ladder_loop"), {{"links", std::to_string(links)}});
    const SceneContent& content = world.content();
    ASSERT_EQ(content.bodies.size(), static_cast<std::size_t>(links));
    ASSERT_EQ(content.joints.size(), links + 1u);
    std::map<dBodyID, int> joints_of;
    for (const dJointID joint : content.joints) {
      ASSERT_EQ(dJointGetType(joint), dJointTypeHinge);
      dVector3 axis;
      dJointGetHingeAxis(joint, axis);
      EXPECT_NEAR(std::abs(axis[0] * 2 + axis[1] * 3 + axis[2] * 6), 7, 1e-12);
      for (const int side : {0, 1}) ++joints_of[dJointGetBody(joint, side)];
    }
    EXPECT_EQ(joints_of[nullptr], 1);
    for (std::size_t i = 0; i < content.bodies.size(); ++i)
      EXPECT_EQ(joints_of[content.bodies[i]], i == 0 ? 3 : 2) << i;
    EXPECT_EQ(world.collide().all, 0) << links;
  }
}

TEST(LadderFree, TouchesNothing) {
  SceneWorld world(scene_named("ladder_free"), {{"boxes", "5"}});
  for (int step = 0; step < 60; ++step) EXPECT_EQ(world.step(step, 20).all, 0);
  EXPECT_LT(dBodyGetPosition(world.content().bodies[4])[2], -4);
}

}  // namespace
}  // namespace cleave
