#include "harness/world/ode_world.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "ode_test_world.h"
#include "scenarios/scene_random.h"
#include "tests/scenarios/shipped_scenes.h"

namespace cleave {
namespace {

TEST(Advance, FollowsTheClosedFormOfAConstantSpin) {
  SceneRandom random(4);
  for (int trial = 0; trial < 50; ++trial) {
    const auto world = make_world([](SceneBuilder& builder) { builder.add_box({{1, 2, 3}}, 1, {1, 2, 3}); });
    BodyState start = world->state(0);
    start.orientation = random.rotation();
    world->set_state(0, start);
    start = world->state(0);
    const double speed = trial % 5 == 0 ? 1e-6 : random.uniform(0, 20);
    double axis[3] = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    const double length = std::hypot(axis[0], axis[1], axis[2]);
    for (double& a : axis) a /= length;
    const double v[6] = {1, -2, 0.5, speed * axis[0], speed * axis[1], speed * axis[2]};
    const double h_s = 1.0 / 60;
    for (int i = 0; i < 60; ++i) world->advance(v, h_s);

    dQuaternion turn, wanted;
    dQFromAxisAndAngle(turn, axis[0], axis[1], axis[2], speed);  // one second
    dQMultiply0(wanted, turn, start.orientation.data());
    const BodyState end = world->state(0);
    double same = 0, norm = 0;
    for (int k = 0; k < 4; ++k) same += wanted[k] * end.orientation[k];
    for (const double q : end.orientation) norm += q * q;
    EXPECT_NEAR(norm, 1, 1e-15);
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(end.orientation[k], std::copysign(1, same) * wanted[k], 1e-12);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(end.position_m[k], start.position_m[k] + v[k], 1e-12);
    for (int k = 0; k < 6; ++k) EXPECT_EQ(end.velocity[k], v[k]);
    EXPECT_EQ(dBodyGetLinearVel(world->content().bodies[0])[1], -2);
  }
}

TEST(Advance, RefusesVelocitiesThatAreNotFinite) {
  const auto world = make_world("rock_pile", {{"bodies", "5"}}, 1);
  const std::uint64_t before = world->state_hash();
  std::vector<double> velocity(30, 1.0);
  velocity[27] = std::numeric_limits<double>::quiet_NaN();
  try {
    world->advance(velocity, 0.01);
    FAIL() << "accepted NaN";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "velocity of body 4 is not finite");
  }
  EXPECT_EQ(world->state_hash(), before);
}

TEST(State, SetThenReadGivesItBack) {
  const auto world = make_world("rock_pile", {{"bodies", "3"}}, 1);
  const BodyState wanted{{1, 2, 3}, {0.5, -0.5, 0.5, 0.5}, {1, 2, 3, 4, 5, 6}};
  world->set_state(1, wanted);
  const BodyState read = world->state(1);
  EXPECT_EQ(read.position_m, wanted.position_m);
  EXPECT_EQ(read.orientation, wanted.orientation);
  EXPECT_EQ(read.velocity, wanted.velocity);
}

TEST(State, HashIsFnv1aOfThirteenNumbersABody) {
  const auto world = make_world("rock_pile", {{"bodies", "3"}}, 1);
  std::uint64_t hash = 14695981039346656037u;
  const auto add = [&](double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    for (int byte = 0; byte < 8; ++byte) hash = (hash ^ (bits >> (8 * byte) & 255)) * 1099511628211u;
  };
  for (int i = 0; i < 3; ++i) {
    const BodyState s = world->state(i);
    for (const double x : s.position_m) add(x);
    for (const double x : s.orientation) add(x);
    for (const double x : s.velocity) add(x);
  }
  EXPECT_EQ(world->state_hash(), hash);
  BodyState moved = world->state(2);
  moved.velocity[5] = 1e-300;
  world->set_state(2, moved);
  EXPECT_NE(world->state_hash(), hash);
}

TEST(State, SameSeedSameHash) {
  for (const ShippedScene& scene : shipped_scenes()) {
    const Settings settings = make_scene_settings(*scene.entry, scene.given);
    const auto hash = [&](std::uint64_t seed) {
      return OdeWorld(*scene.entry, settings, seed, 9.81).state_hash();
    };
    EXPECT_EQ(hash(3), hash(3)) << scene.name;
    EXPECT_EQ(hash(3) != hash(4), scene.draws) << scene.name;
  }
}

TEST(Energy, MatchesTheClosedForm) {
  const auto world = make_world([](SceneBuilder& builder) {
    builder.add_box({{0, 0, 2}}, 6, {1, 2, 3});
    builder.add_sphere({{5, 0, -1}}, 2, 0.5);
  });
  EXPECT_NEAR(world->potential_energy_j(), 9.81 * (6 * 2 - 2 * 1), 1e-12);
  EXPECT_EQ(world->kinetic_energy_j(), 0);
  BodyState box = world->state(0);
  box.orientation = orientation_along({1, 0, 0});  // its z axis lies along the world's x
  box.velocity = {3, 0, 4, 2, 0, 0};
  world->set_state(0, box);
  // I about the box's own z: 6 / 12 (1 + 4).
  EXPECT_NEAR(world->kinetic_energy_j(), 0.5 * 6 * 25 + 0.5 * 2.5 * 4, 1e-12);
}

TEST(Messages, AreCountedAndTheFirstIsKept) {
  const auto world = make_world("rock_pile", {{"bodies", "1"}}, 1);
  world->take_message_count();
  std::string text = "none";
  EXPECT_EQ(world->take_message_count(&text), 0);
  EXPECT_EQ(text, "none");
  dMessage(d_ERR_LCP, "LCP internal error, s <= 0 (s=%.1e)", -1.0);
  dMessage(0, "another");
  EXPECT_EQ(world->take_message_count(&text), 2);
  EXPECT_EQ(text, "LCP internal error, s <= 0 (s=-1.0e+00)");
  EXPECT_EQ(world->take_message_count(), 0);
}

TEST(Messages, OdesOwnErrorsAreThrownAndTheWorldSurvives) {
  const auto world = make_world("rock_pile", {{"bodies", "2"}}, 1);
  EXPECT_THROW(dWorldStep(world->world(), 0), std::runtime_error);
  EXPECT_THROW(dWorldQuickStep(world->world(), -1), std::runtime_error);
  EXPECT_THROW(dError(1, "error %d", 3), std::runtime_error);
  dWorldStep(world->world(), 1.0 / 60);
  EXPECT_NEAR(world->state(0).velocity[2], -9.81 / 60, 1e-12);
}

TEST(OdeWorld, SetsWhatEveryBodyNeeds) {
  for (const bool gyroscopic : {true, false}) {
    const SceneEntry& entry = scenes()[0];
    const OdeWorld world(entry, make_scene_settings(entry, {}), 1, 3.7, gyroscopic);
    dVector3 gravity;
    dWorldGetGravity(world.world(), gravity);
    EXPECT_EQ(gravity[2], -3.7);
    for (int i = 0; i < world.body_count(); ++i) {
      const dBodyID body = world.content().bodies[i];
      EXPECT_EQ(dBodyGetGyroscopicMode(body) != 0, gyroscopic);
      EXPECT_EQ(dBodyGetAutoDisableFlag(body), 0);
      EXPECT_EQ(world.body_index(body), i);
    }
    EXPECT_EQ(world.body_index(nullptr), -1);
  }
}

TEST(OdeWorld, RefusesTriangleMeshes) {
  const dTriMeshDataID mesh = dGeomTriMeshDataCreate();
  const double vertices[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const dTriIndex triangle[] = {0, 1, 2};
  dGeomTriMeshDataBuildDouble(mesh, vertices, 3 * sizeof(double), 3, triangle, 3, 3 * sizeof(dTriIndex));
  const auto build = [&](dWorldID, dSpaceID space, SceneContent& content) {
    content.geoms.push_back(dCreateTriMesh(space, mesh, nullptr, nullptr, nullptr));
  };
  EXPECT_THROW(make_world(build), std::invalid_argument);
  dGeomTriMeshDataDestroy(mesh);
}

}  // namespace
}  // namespace cleave
