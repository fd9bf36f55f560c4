// How deep piles lie: rock_pile's --depth, and the silo.
#include <gtest/gtest.h>

#include "scene_world.h"

namespace cleave {
namespace {

constexpr double kMeanHeight_m = 0.65;  // of a rock's edges, and of a layer of the silo

double half_width_m(const SceneContent& content) {
  double widest = 0;
  for (const dGeomID geom : content.geoms) {
    if (dGeomGetClass(geom) != dPlaneClass) continue;
    dVector4 plane;
    dGeomPlaneGetParams(geom, plane);
    widest = std::max<double>(widest, -plane[3]);
  }
  return widest;
}

// The middle of a pile of even depth is the mean of its bodies' heights.
double layers(const SceneContent& content) {
  double sum_m = 0;
  for (const dBodyID body : content.bodies) sum_m += dBodyGetPosition(body)[2];
  return 2 * sum_m / static_cast<double>(content.bodies.size()) / kMeanHeight_m;
}

double farthest_corner_m(dGeomID box) {
  dReal bounds[6];
  dGeomGetAABB(box, bounds);
  return std::max({-bounds[0], bounds[1], -bounds[2], bounds[3]});
}

void expect_inside_walls(const SceneContent& content, double give_m) {
  const double wall_m = half_width_m(content) + give_m;
  for (const dGeomID geom : content.geoms) {
    if (dGeomGetBody(geom) == nullptr) continue;
    EXPECT_LE(farthest_corner_m(geom), wall_m);
  }
}

// Within a quarter, and half a layer for what lies askew and for columns that must be whole.
TEST(RockPile, ComesToRestAboutAsDeepAsAsked) {
  for (const int depth : {1, 3, 6, 10}) {
    SceneWorld world(scene_named("rock_pile"), {{"bodies", "150"}, {"depth", std::to_string(depth)}});
    for (int step = 0; step < 250; ++step) world.step(step, 30);
    EXPECT_NEAR(layers(world.content()), depth, 0.25 * depth + 0.5);
    expect_inside_walls(world.content(), 0.1);
  }
}

TEST(RockPile, GrowsInWidthWhereItsDepthStays) {
  const auto half_width = [](const char* bodies, const char* depth) {
    SceneWorld world(scene_named("rock_pile"), {{"bodies", bodies}, {"depth", depth}});
    return half_width_m(world.content());
  };
  EXPECT_DOUBLE_EQ(half_width("1800", "3"), 3 * half_width("200", "3"));
  EXPECT_DOUBLE_EQ(half_width("1800", "27"), half_width("200", "3"));
}

TEST(Silo, IsAboutAsHighAsItIsWide) {
  for (const int bodies : {150, 500, 2000, 27000}) {
    SceneWorld world(scene_named("silo"), {{"bodies", std::to_string(bodies)}});
    const double height_m = highest_m(world.content()) + kMeanHeight_m / 2;
    EXPECT_NEAR(height_m / (2 * half_width_m(world.content())), 1, bodies < 1000 ? 0.25 : 0.05) << bodies;
    expect_inside_walls(world.content(), 0);
    if (bodies < 1000) {
      EXPECT_GT(world.collide().between_bodies, 3 * bodies);
    }
  }
}

TEST(Silo, StaysAsItWasBuilt) {
  SceneWorld world(scene_named("silo"), {{"bodies", "400"}});
  const SceneContent& content = world.content();
  EXPECT_NEAR(layers(content), 7.2, 0.2);
  std::vector<std::array<double, 3>> start;
  for (const dBodyID body : content.bodies) {
    const dReal* x = dBodyGetPosition(body);
    start.push_back({x[0], x[1], x[2]});
  }
  for (int step = 0; step < 120; ++step) {
    const SceneWorld::Contacts contacts = world.step(step, 50);
    EXPECT_LT(contacts.largest_depth_m, 0.01);
    if (step > 20) {
      EXPECT_GT(contacts.between_bodies, 6 * 400);
    }
  }
  for (std::size_t i = 0; i < start.size(); ++i)
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(dBodyGetPosition(content.bodies[i])[k], start[i][k], 0.02) << "body " << i;
  EXPECT_NEAR(layers(content), 7.2, 0.2);
  expect_inside_walls(content, 0.01);
}

}  // namespace
}  // namespace cleave
