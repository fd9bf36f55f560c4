// OdeWorld::collide.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <tuple>

#include "ode_test_world.h"
#include "scenarios/scene_random.h"

namespace cleave {
namespace {

// Throws the bodies together so that many overlap.
void scatter(OdeWorld& world, std::uint64_t seed, double reach_m) {
  SceneRandom random(seed);
  for (int i = 0; i < world.body_count(); ++i) {
    BodyState state;
    for (double& x : state.position_m) x = random.uniform(-reach_m, reach_m);
    state.orientation = random.rotation();
    world.set_state(i, state);
  }
}

TEST(Collide, ContactsAreSortedUnitAndOwnedByTheLowerBody) {
  for (const std::string shape : {"box", "sphere", "clump", "convex"}) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      SCOPED_TRACE(shape + " seed " + std::to_string(seed));
      const auto world = make_world("rock_pile", {{"bodies", "40"}, {"rock-shape", shape}}, seed);
      scatter(*world, seed, 1.2);
      const std::vector<ContactPoint> contacts = world->collide(8, nullptr);
      ASSERT_GT(contacts.size(), 50u);
      auto previous = std::make_tuple(-1, -1, -1, -1);
      for (const ContactPoint& c : contacts) {
        ASSERT_GE(c.body_a, 0);
        EXPECT_TRUE(c.body_b == -1 || c.body_a < c.body_b);
        EXPECT_EQ(world->body_index(dGeomGetBody(world->content().geoms[c.geom_a])), c.body_a);
        EXPECT_EQ(world->body_index(dGeomGetBody(world->content().geoms[c.geom_b])), c.body_b);
        const auto& n = c.normal;
        EXPECT_NEAR(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1, 1e-12);
        EXPECT_GE(c.depth_m, 0);
        const auto key =
            std::make_tuple(c.body_a, c.body_b, std::min(c.geom_a, c.geom_b), std::max(c.geom_a, c.geom_b));
        EXPECT_LE(previous, key);
        previous = key;
      }
    }
  }
}

TEST(Collide, FindsTheSameAsEveryPairTriedByHand) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto world = make_world("rock_pile", {{"bodies", "40"}, {"rock-shape", "clump"}}, seed);
    scatter(*world, seed, 1.2);
    const auto& geoms = world->content().geoms;
    std::size_t count = 0;
    for (std::size_t i = 0; i < geoms.size(); ++i)
      for (std::size_t j = i + 1; j < geoms.size(); ++j) {
        dContactGeom found[8];
        if (dGeomGetBody(geoms[i]) != dGeomGetBody(geoms[j]))
          count += dCollide(geoms[i], geoms[j], 8, found, sizeof(dContactGeom));
      }
    EXPECT_EQ(world->collide(8, nullptr).size(), count) << "seed " << seed;
  }
}

TEST(Collide, NormalPointsFromTheOtherBodyIntoTheLowerOne) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto world = make_world("rock_pile", {{"bodies", "40"}, {"rock-shape", "sphere"}}, seed);
    scatter(*world, seed, 1.2);
    for (const ContactPoint& c : world->collide(8, nullptr)) {
      if (c.body_b < 0) continue;
      const auto a = world->state(c.body_a).position_m, b = world->state(c.body_b).position_m;
      const double distance = std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
      for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(c.normal[k], (a[k] - b[k]) / distance, 1e-12) << "seed " << seed;
    }
  }
}

TEST(Collide, StaticGeometryFirstOrLastGivesTheSameContacts) {
  for (const bool plane_first : {true, false}) {
    const auto world = make_world([&](SceneBuilder& builder) {
      if (plane_first) builder.add_plane({0, 0, 1}, 0);
      builder.add_sphere({{0, 0, 0.45}}, 1, 0.5);
      if (!plane_first) builder.add_plane({0, 0, 1}, 0);
    });
    const std::vector<ContactPoint> contacts = world->collide(8, nullptr);
    ASSERT_EQ(contacts.size(), 1u);
    EXPECT_EQ(contacts[0].body_a, 0);
    EXPECT_EQ(contacts[0].body_b, -1);
    EXPECT_EQ(contacts[0].geom_a, plane_first ? 1 : 0);
    EXPECT_EQ(contacts[0].geom_b, plane_first ? 0 : 1);
    EXPECT_NEAR(contacts[0].normal[2], 1, 1e-15);
    EXPECT_NEAR(contacts[0].depth_m, 0.05, 1e-15);
  }
}

// Bodies are the same; only the order in which their spheres are entered differs.
TEST(Collide, OrderOfGeometryDoesNotTurnTheNormal) {
  for (const bool reversed : {false, true}) {
    const auto world = make_world([&](dWorldID world, dSpaceID space, SceneContent& content) {
      for (int i = 0; i < 2; ++i) {
        content.bodies.push_back(dBodyCreate(world));
        content.geoms.push_back(dCreateSphere(space, 0.5));
        dGeomSetBody(content.geoms[i], content.bodies[i]);
        dBodySetPosition(content.bodies[i], 0, 0, 0.9 * i);
      }
      if (reversed) std::swap(content.geoms[0], content.geoms[1]);
    });
    const std::vector<ContactPoint> contacts = world->collide(8, nullptr);
    ASSERT_EQ(contacts.size(), 1u);
    EXPECT_EQ(contacts[0].body_a, 0);
    EXPECT_EQ(contacts[0].body_b, 1);
    EXPECT_EQ(contacts[0].geom_a, reversed ? 1 : 0);
    EXPECT_NEAR(contacts[0].normal[2], -1, 1e-15);
  }
}

TEST(Collide, CapLimitsContactsAndIsCounted) {
  const auto world = make_world([](SceneBuilder& builder) {
    builder.add_plane({0, 0, 1}, 0);
    builder.add_box({{0, 0, 0.49}}, 1, {1, 1, 1});
    builder.add_sphere({{5, 0, 0.49}}, 1, 0.5);
  });
  const struct { int cap, contacts, hits; } cases[] = {{8, 5, 0}, {5, 5, 0}, {4, 5, 1}, {2, 3, 1}, {1, 2, 2}};
  for (const auto& c : cases) {
    int hits = -1;
    EXPECT_EQ(world->collide(c.cap, &hits).size(), static_cast<std::size_t>(c.contacts)) << c.cap;
    EXPECT_EQ(hits, c.hits) << c.cap;
  }
  EXPECT_THROW(world->collide(0, nullptr), std::invalid_argument);
  EXPECT_THROW(world->collide(65536, nullptr), std::invalid_argument);
}

TEST(Collide, JoinedBodiesDoNotCollideButDoMeetTheGround) {
  const auto world = make_world([](SceneBuilder& builder) {
    builder.add_plane({0, 0, 1}, 0);
    const dBodyID a = builder.add_sphere({{0, 0, 0.45}}, 1, 0.5);
    const dBodyID b = builder.add_sphere({{0.5, 0, 0.45}}, 1, 0.5);
    builder.add_sphere({{1, 0, 0.6}}, 1, 0.5);
    builder.add_ball_joint(a, b, {0.25, 0, 0.45});
    builder.add_ball_joint(a, nullptr, {0, 0, 0.45});  // to the world
  });
  std::vector<std::pair<int, int>> pairs;
  for (const ContactPoint& c : world->collide(8, nullptr)) pairs.emplace_back(c.body_a, c.body_b);
  EXPECT_EQ(pairs, (std::vector<std::pair<int, int>>{{0, -1}, {1, -1}, {1, 2}}));
}

TEST(Collide, ContactsThatAreNotFiniteAreRefused) {
  const auto world = make_world("rock_pile", {{"bodies", "20"}}, 1);
  BodyState lost = world->state(3);
  lost.position_m[1] = std::numeric_limits<double>::quiet_NaN();
  world->set_state(3, lost);
  EXPECT_THROW(world->collide(8, nullptr), std::runtime_error);
}

TEST(Collide, ContactJointsInTheWorldDoNotHideContacts) {
  const auto world = make_world("log_tower", {{"layers", "2"}, {"logs", "2"}}, 1);
  const std::size_t count = world->collide(8, nullptr).size();
  dContact contact{};
  const dJointGroupID group = dJointGroupCreate(0);
  dJointAttach(dJointCreateContact(world->world(), group, &contact), world->content().bodies[0],
               world->content().bodies[2]);
  EXPECT_EQ(world->collide(8, nullptr).size(), count);
  dJointGroupDestroy(group);
}

}  // namespace
}  // namespace cleave
