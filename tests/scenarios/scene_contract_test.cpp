// What every scene of the registry promises, whatever its parameters.
#include <gtest/gtest.h>

#include <cmath>

#include "scenario_text.h"
#include "scene_world.h"
#include "shipped_scenes.h"
#include "snapshot.h"

namespace cleave {
namespace {

using Given = std::map<std::string, std::string>;

struct Case {
  ShippedScene scene;
  Given given;
};

std::string describe(const Case& c) {
  std::string text = c.scene.name;
  for (const auto& [name, value] : c.given) text += " --" + name + " " + value;
  return text;
}

// Defaults, every whole number at its least, and every choice with the other parameters at their defaults.
std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const ShippedScene& scene : shipped_scenes()) {
    const auto with = [&](const std::string& name, const std::string& value) {
      Given given = scene.given;
      given[name] = value;
      cases.push_back({scene, given});
    };
    Given smallest = scene.given;
    cases.push_back({scene, scene.given});
    for (const Parameter& parameter : scene.entry->parameters) {
      if (parameter.kind == Parameter::Kind::integer) {
        with(parameter.name, number_text(parameter.range.min));
        smallest[parameter.name] = number_text(parameter.range.min);
      }
      for (const std::string& choice : parameter.words) with(parameter.name, choice);
    }
    if (smallest != scene.given) cases.push_back({scene, smallest});
  }
  return cases;
}

// The ladder's scenes are set up to break solvers: a few steps of an iterative one send bodies anywhere.
bool of_ladder(const ShippedScene& scene) { return scene.name.starts_with("ladder_"); }

// Widest gap between the anchors of a ball joint or hinge; sliders and fixed joints have none, and begin
// where they are.
double gap_m(dJointID joint) {
  const dJointType type = dJointGetType(joint);
  if (type == dJointTypeSlider || type == dJointTypeFixed) return 0;
  const bool ball = type == dJointTypeBall;
  EXPECT_TRUE(ball || type == dJointTypeHinge);
  dVector3 a, b, gap;
  (ball ? dJointGetBallAnchor : dJointGetHingeAnchor)(joint, a);
  (ball ? dJointGetBallAnchor2 : dJointGetHingeAnchor2)(joint, b);
  dSubtractVectors3(gap, a, b);
  return dCalcVectorLength3(gap);
}

// By leading minors; ODE stores rows of four.
bool positive_definite(const dReal* inertia) {
  const auto at = [inertia](int i, int j) { return inertia[4 * i + j]; };
  const double minor2 = at(0, 0) * at(1, 1) - at(0, 1) * at(1, 0);
  const double minor3 = at(0, 0) * (at(1, 1) * at(2, 2) - at(1, 2) * at(2, 1)) -
                        at(0, 1) * (at(1, 0) * at(2, 2) - at(1, 2) * at(2, 0)) +
                        at(0, 2) * (at(1, 0) * at(2, 1) - at(1, 1) * at(2, 0));
  return at(0, 0) > 0 && minor2 > 0 && minor3 > 0;
}

TEST(SceneContract, StartsAtRestWithoutOverlap) {
  for (const Case& c : all_cases()) {
    for (const std::uint64_t seed : {1, 2, 3}) {
      SceneWorld world(*c.scene.entry, c.given, seed);
      EXPECT_LE(world.collide().largest_depth_m, 1e-6) << describe(c) << " seed " << seed;
      for (const dBodyID body : world.content().bodies) EXPECT_EQ(speed_m_per_s(body), 0) << describe(c);
      for (const dJointID joint : world.content().joints) EXPECT_LT(gap_m(joint), 1e-12) << describe(c);
    }
  }
}

TEST(SceneContract, BodiesHaveMassInertiaAndGeometry) {
  for (const Case& c : all_cases()) {
    SceneWorld world(*c.scene.entry, c.given);
    ASSERT_FALSE(world.content().bodies.empty()) << describe(c);
    std::map<dBodyID, int> geoms_of;
    for (const dGeomID geom : world.content().geoms) ++geoms_of[dGeomGetBody(geom)];
    if (!of_ladder(c.scene)) {
      EXPECT_GT(geoms_of[nullptr], 0) << describe(c) << ": nothing to fall on";
    }
    for (const dBodyID body : world.content().bodies) {
      dMass mass;
      dBodyGetMass(body, &mass);
      EXPECT_GT(mass.mass, 0) << describe(c);
      EXPECT_TRUE(positive_definite(mass.I)) << describe(c);
      EXPECT_EQ(dCalcVectorDot3(mass.c, mass.c), 0) << describe(c);
      EXPECT_GT(geoms_of[body], 0) << describe(c);
    }
  }
}

TEST(SceneContract, TheSeedAndNothingElseDecides) {
  for (const Case& c : all_cases()) {
    if (c.given.size() > c.scene.given.size() + 1) continue;
    SceneWorld a(*c.scene.entry, c.given, 5), b(*c.scene.entry, c.given, 5),
        other(*c.scene.entry, c.given, 6);
    EXPECT_EQ(snapshot(a.content()), snapshot(b.content())) << describe(c);
    EXPECT_EQ(snapshot(a.content()) != snapshot(other.content()), c.scene.draws) << describe(c);
  }
}

TEST(SceneContract, NothingFallsThroughTheStaticPlanes) {
  int scenes_seen = 0, bodies_above = 0;
  for (const ShippedScene& scene : shipped_scenes()) {
    if (of_ladder(scene)) continue;
    Given small = scene.given;
    for (const Parameter& parameter : scene.entry->parameters)
      if (parameter.kind == Parameter::Kind::integer)
        small[parameter.name] = number_text(std::max(
            parameter.range.min, std::floor(std::min(30.0, std::stod(parameter.default_value)) / 3)));
    SceneWorld world(*scene.entry, small.count("logs") ? Given{{"layers", "5"}, {"logs", "3"}} : small);
    for (int step = 0; step < 200; ++step) world.step(step, 30);
    for (const dGeomID geom : world.content().geoms) {
      if (dGeomGetClass(geom) != dPlaneClass) continue;
      dVector4 plane;
      dGeomPlaneGetParams(geom, plane);
      for (const dBodyID body : world.content().bodies)
        EXPECT_GT(dCalcVectorDot3(plane, dBodyGetPosition(body)), plane[3]) << scene.name;
      bodies_above += static_cast<int>(world.content().bodies.size());
    }
    ++scenes_seen;
  }
  EXPECT_GE(scenes_seen, 3);
  EXPECT_GE(bodies_above, 50);
}

}  // namespace
}  // namespace cleave
