// What the scenes and the harness rely on in ODE's collision; a new ODE that differs should be noticed here
// first.
#include <gtest/gtest.h>
#include <ode/ode.h>

#include <algorithm>
#include <cstdarg>
#include <vector>

#include "scenarios/scene_random.h"
#include "scenarios/shapes.h"

namespace cleave {
namespace {

class OdeFacts : public ::testing::Test {
 protected:
  OdeFacts() {
    dInitODE2(0);
    dAllocateODEDataForThread(dAllocateMaskAll);
    world_ = dWorldCreate();
    space_ = dSimpleSpaceCreate(nullptr);
  }
  ~OdeFacts() override {
    dSpaceDestroy(space_);
    dWorldDestroy(world_);
  }

  std::vector<dContactGeom> collide(dGeomID a, dGeomID b) {
    std::vector<dContactGeom> contacts(16);
    contacts.resize(dCollide(a, b, 16, contacts.data(), sizeof(dContactGeom)));
    return contacts;
  }
  dGeomID geom(dBodyID body) { return dBodyGetFirstGeom(body); }

  dWorldID world_;
  dSpaceID space_;
};

const std::array<double, 4> kAlongX = orientation_along({1, 0, 0});
const std::array<double, 4> kAlongY = orientation_along({0, 1, 0});

TEST_F(OdeFacts, NormalPointsIntoTheFirstGeometry) {
  SceneBuilder builder(world_, space_);
  const dGeomID low = geom(builder.add_sphere({{0, 0, 0}}, 1, 0.5));
  const dGeomID high = geom(builder.add_sphere({{0, 0, 0.9}}, 1, 0.5));
  builder.add_plane({0, 0, 1}, -0.4);
  const dGeomID plane = builder.take().geoms.back();
  ASSERT_EQ(collide(high, low).size(), 1u);
  EXPECT_NEAR(collide(high, low)[0].normal[2], 1, 1e-15);
  EXPECT_NEAR(collide(low, high)[0].normal[2], -1, 1e-15);
  EXPECT_NEAR(collide(low, plane)[0].normal[2], 1, 1e-15);
  EXPECT_NEAR(collide(plane, low)[0].normal[2], -1, 1e-15);
  EXPECT_NEAR(collide(plane, low)[0].depth, 0.1, 1e-15);
}

TEST_F(OdeFacts, CapsulesGiveTwoContactsWhereParallelAndOneWhereCrossing) {
  SceneBuilder builder(world_, space_);
  const dGeomID low = geom(builder.add_capsule({{0, 0, 0}, kAlongX}, 1, 0.15, 3));
  const dGeomID beside = geom(builder.add_capsule({{0, 0.299, 0}, kAlongX}, 1, 0.15, 3));
  const dGeomID across = geom(builder.add_capsule({{0, 0, 0.299}, kAlongY}, 1, 0.15, 3));
  builder.add_plane({0, 0, 1}, -0.149);
  EXPECT_EQ(collide(low, beside).size(), 2u);
  EXPECT_EQ(collide(low, across).size(), 1u);
  EXPECT_EQ(collide(low, builder.take().geoms.back()).size(), 2u);
}

TEST_F(OdeFacts, CapsuleLengthExcludesTheRoundEnds) {
  SceneBuilder builder(world_, space_);
  dReal box[6];
  dGeomGetAABB(geom(builder.add_capsule({}, 1, 0.15, 3)), box);
  EXPECT_NEAR(box[5] - box[4], 3.3, 1e-12);
}

TEST_F(OdeFacts, BoxesGiveFourToEightContactsFaceToFace) {
  SceneRandom random(1);
  for (int i = 0; i < 100; ++i) {
    SceneBuilder builder(world_, space_);
    const double turn = random.uniform(0, 3);
    const dGeomID low = geom(builder.add_box({{0, 0, 0}}, 1, {1, 1, 1}));
    const dGeomID high = geom(
        builder.add_box({{0.1, 0.05, 0.999}, {std::cos(turn / 2), 0, 0, std::sin(turn / 2)}}, 1, {1, 1, 1}));
    const std::size_t contacts = collide(low, high).size();
    EXPECT_GE(contacts, 4u);
    EXPECT_LE(contacts, 8u);
  }
}

TEST_F(OdeFacts, BoxOnPlaneGivesFourContacts) {
  SceneBuilder builder(world_, space_);
  const dGeomID box = geom(builder.add_box({{0, 0, 0.499}}, 1, {1, 1, 1}));
  builder.add_plane({0, 0, 1}, 0);
  EXPECT_EQ(collide(box, builder.take().geoms.back()).size(), 4u);
}

TEST_F(OdeFacts, ConvexPairsAndCrossingCylindersGiveOneContact) {
  const ConvexHull hull = make_tapered_box({1, 1, 1}, {0, 0, 0});
  SceneBuilder builder(world_, space_);
  const dGeomID low = geom(builder.add_convex({{0, 0, 0}}, 1, hull));
  const dGeomID high = geom(builder.add_convex({{0.1, 0.05, 0.999}}, 1, hull));
  EXPECT_EQ(collide(low, high).size(), 1u);
  const dGeomID along_x = geom(builder.add_cylinder({{5, 0, 0}, kAlongX}, 1, 0.15, 3));
  const dGeomID along_y = geom(builder.add_cylinder({{5, 0, 0.299}, kAlongY}, 1, 0.15, 3));
  EXPECT_EQ(collide(along_x, along_y).size(), 1u);
}

TEST_F(OdeFacts, ConvexGeometryTakesAnOffsetLikeAnyOther) {
  const ConvexHull hull = make_tapered_box({1, 1, 1}, {0.5, 0, 0});
  SceneBuilder builder(world_, space_);
  const dBodyID body = builder.add_convex({{0, 0, 0.499}}, 1, hull);
  builder.add_plane({0, 0, 1}, 0);
  EXPECT_NE(dBodyGetPosition(body)[0], 0);
  // Tapered along x, so only the edge at the wide end touches.
  const std::vector<dContactGeom> contacts = collide(geom(body), builder.take().geoms.back());
  ASSERT_EQ(contacts.size(), 2u);
  for (const dContactGeom& contact : contacts) {
    EXPECT_NEAR(contact.depth, 0.001, 1e-12);
    EXPECT_NEAR(contact.pos[0], -0.5, 1e-12);
  }
}

struct Touch {
  double overlap_m, layer_m, offset_m;
};

class OdeStacks : public OdeFacts {
 protected:
  // How often dWorldStep complains in the first step of six unit cubes on each other without friction.
  int messages_of_a_step(const Touch& touch, bool bottom_up) {
    SceneBuilder builder(world_, space_);
    std::vector<dBodyID> boxes;  // in the order they are made
    for (int i = 0; i < kBoxes; ++i) {
      const int place = bottom_up ? i : kBoxes - 1 - i;
      const double z = 0.5 - touch.overlap_m + place * (1 - touch.overlap_m);
      boxes.push_back(builder.add_box(
          {{touch.offset_m * std::cos(2.4 * place), touch.offset_m * std::sin(2.4 * place), z}}, 1,
          {1, 1, 1}));
    }
    if (!bottom_up) std::ranges::reverse(boxes);
    builder.add_plane({0, 0, 1}, 0);
    dWorldSetGravity(world_, 0, 0, -9.81);
    dWorldSetERP(world_, 0.2);
    dWorldSetCFM(world_, 1e-10);
    dWorldSetContactSurfaceLayer(world_, touch.layer_m);
    for (int i = kBoxes - 1; i > 0; --i) join(geom(boxes[i - 1]), geom(boxes[i]));
    join(geom(boxes[0]), builder.take().geoms.back());
    messages_ = 0;
    dSetMessageHandler([](int, const char*, std::va_list) { ++messages_; });
    dWorldStep(world_, 1.0 / 60);
    dSetMessageHandler(nullptr);
    return messages_;
  }

 private:
  static constexpr int kBoxes = 6;

  void join(dGeomID a, dGeomID b) {
    for (const dContactGeom& found : collide(a, b)) {
      dContact contact{};
      contact.geom = found;
      dJointAttach(dJointCreateContact(world_, nullptr, &contact), dGeomGetBody(a), dGeomGetBody(b));
    }
  }

  inline static int messages_ = 0;
};

// Bodies, and the joints of a body, are taken up from the one made last. From the top down every contact
// between boxes starts exactly at the velocity it asks for, nothing, until those on the ground are driven:
// then the first pivot has length 0.
TEST_F(OdeStacks, WorldStepGivesUpWhereNoContactIsPushedOut) {
  EXPECT_GT(messages_of_a_step({1e-7, 1e-6, 0}, true), 0);
}

TEST_F(OdeStacks, WorldStepGivesUpOnExactlyTouchingBoxes) {
  EXPECT_GT(messages_of_a_step({0, 0, 0}, true), 0);
}

TEST_F(OdeStacks, WorldStepSolvesTheSameStackMadeFromTheTopDown) {
  EXPECT_EQ(messages_of_a_step({1e-7, 1e-6, 0}, false), 0);
}

TEST_F(OdeStacks, BoxesOffTheAxisAloneDoNotHelpWorldStep) {
  EXPECT_GT(messages_of_a_step({1e-7, 1e-6, 1e-3}, true), 0);
}

TEST_F(OdeStacks, WorldStepSolvesAStackThatIsPushedOutAndOffItsAxis) {
  EXPECT_EQ(messages_of_a_step({1e-6, 5e-7, 1e-3}, true), 0);
}

}  // namespace
}  // namespace cleave
