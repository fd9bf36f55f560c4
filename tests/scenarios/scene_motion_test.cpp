// The four scenes do what they are named for when ODE itself steps them.
#include <gtest/gtest.h>

#include "scene_world.h"

namespace cleave {
namespace {

double mass_kg(dBodyID body) {
  dMass mass;
  dBodyGetMass(body, &mass);
  return mass.mass;
}

int moving_bodies(const SceneContent& content, double limit_m_per_s) {
  return static_cast<int>(std::count_if(content.bodies.begin(), content.bodies.end(),
                                        [&](dBodyID body) { return speed_m_per_s(body) > limit_m_per_s; }));
}

TEST(ChainDrop, HasLinksOfOneKilogramAndABob) {
  SceneWorld world(scene_named("chain_drop"), {{"links", "30"}, {"bob-mass", "250"}});
  const SceneContent& content = world.content();
  ASSERT_EQ(content.bodies.size(), 30u);
  ASSERT_EQ(content.joints.size(), 29u);
  for (int i = 0; i < 29; ++i) {
    EXPECT_EQ(mass_kg(content.bodies[i]), 1);
    EXPECT_EQ(dJointGetBody(content.joints[i], 0), content.bodies[i]);
    EXPECT_EQ(dJointGetBody(content.joints[i], 1), content.bodies[i + 1]);
    EXPECT_EQ(dBodyGetPosition(content.bodies[i])[2], 2);
  }
  EXPECT_EQ(mass_kg(content.bodies[29]), 250);
}

TEST(ChainDrop, LongChainsAreLaidOutClear) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SceneWorld world(scene_named("chain_drop"), {{"links", std::to_string(57 * seed)}}, seed);
    EXPECT_EQ(world.collide().all, 0) << "seed " << seed;
  }
}

TEST(ChainDrop, HeapsUp) {
  SceneWorld world(scene_named("chain_drop"), {});
  int steps_with_contacts = 0;
  SceneWorld::Contacts contacts;
  for (int step = 0; step < 300; ++step) {
    contacts = world.step(step, 50);
    steps_with_contacts += contacts.all > 0;
  }
  EXPECT_GT(steps_with_contacts, 200);
  EXPECT_GT(contacts.between_bodies, 50);
  EXPECT_LT(highest_m(world.content()), 1.5);
  EXPECT_LE(moving_bodies(world.content(), 0.5), 5);
}

TEST(LogTower, StandsUntilTheBallAndFallsAfterwards) {
  SceneWorld world(scene_named("log_tower"), {{"layers", "12"}});
  const SceneContent& content = world.content();
  ASSERT_EQ(content.bodies.size(), 61u);
  std::vector<std::array<double, 3>> start;
  for (const dBodyID body : content.bodies) {
    const dReal* x = dBodyGetPosition(body);
    start.push_back({x[0], x[1], x[2]});
    EXPECT_EQ(mass_kg(body), body == content.bodies.back() ? 500 : 50);
  }
  for (int step = 0; step < 60; ++step) EXPECT_EQ(world.step(step, 100).between_bodies, 11 * 25) << step;
  for (std::size_t i = 0; i < content.bodies.size(); ++i)
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(dBodyGetPosition(content.bodies[i])[k], start[i][k], i == 60 ? 0 : 0.02) << "body " << i;
  for (int step = 60; step < 300; ++step) world.step(step, 100);
  EXPECT_LT(highest_m(content), 0.5 * start[59][2]);
}

TEST(RockPile, SettlesInThePit) {
  for (const std::string shape : {"box", "sphere", "clump", "convex"}) {
    SceneWorld world(scene_named("rock_pile"), {{"bodies", "60"}, {"rock-shape", shape}});
    ASSERT_EQ(world.content().bodies.size(), 60u);
    EXPECT_EQ(world.collide().all, 0);
    const double start_m = highest_m(world.content());
    SceneWorld::Contacts contacts;
    for (int step = 0; step < 300; ++step) contacts = world.step(step, 50);
    EXPECT_LT(highest_m(world.content()), 0.6 * start_m) << shape;
    EXPECT_GT(contacts.between_bodies, 60) << shape;
    EXPECT_LE(moving_bodies(world.content(), 0.5), 12) << shape;  // spheres go on rolling for a while
  }
}

TEST(RockPile, DrawsEveryMassOfTheList) {
  SceneWorld world(scene_named("large_rock_pile"), {});
  std::map<double, int> count;
  for (const dBodyID body : world.content().bodies) ++count[mass_kg(body)];
  ASSERT_EQ(world.content().bodies.size(), 600u);
  ASSERT_EQ(count.size(), 3u);
  for (const double mass : {10, 100, 1000}) EXPECT_GT(count[mass], 150) << mass;
  SceneWorld equal(scene_named("rock_pile"), {});
  ASSERT_EQ(equal.content().bodies.size(), 200u);
  for (const dBodyID body : equal.content().bodies) EXPECT_EQ(mass_kg(body), 100);
}

TEST(RockPile, EdgesAreDrawnFromTheirRange) {
  SceneWorld world(scene_named("rock_pile"), {});
  double least = 1, most = 0;
  for (const dGeomID geom : world.content().geoms) {
    if (dGeomGetClass(geom) != dBoxClass) continue;
    dVector3 edges;
    dGeomBoxGetLengths(geom, edges);
    EXPECT_NE(edges[0], edges[1]);
    for (int k = 0; k < 3; ++k) {
      least = std::min<double>(least, edges[k]);
      most = std::max<double>(most, edges[k]);
    }
  }
  EXPECT_GE(least, 0.5);
  EXPECT_LT(least, 0.51);
  EXPECT_LE(most, 0.8);
  EXPECT_GT(most, 0.79);
}

}  // namespace
}  // namespace cleave
