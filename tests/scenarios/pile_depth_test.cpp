// How deep piles lie: rock_pile's --depth, and the silo.
#include <gtest/gtest.h>

#include "scene_world.h"

namespace cleave {
namespace {

constexpr double kMeanEdge_m = 0.65;

struct Pit {
  double half_width_m = 0;
  double highest_m = 0;  // centre of the highest body
  double mean_m = 0;     // of all centres

  explicit Pit(const SceneContent& content) : highest_m(cleave::highest_m(content)) {
    for (const dGeomID geom : content.geoms) {
      if (dGeomGetClass(geom) != dPlaneClass) continue;
      dVector4 plane;
      dGeomPlaneGetParams(geom, plane);
      half_width_m = std::max<double>(half_width_m, -plane[3]);
    }
    for (const dBodyID body : content.bodies)
      mean_m += dBodyGetPosition(body)[2] / static_cast<double>(content.bodies.size());
  }
  // A pile of even depth has its mean height in the middle.
  double layers() const { return 2 * mean_m / kMeanEdge_m; }
};

double farthest_corner_m(dGeomID box) {
  dReal bounds[6];
  dGeomGetAABB(box, bounds);
  return std::max({-bounds[0], bounds[1], -bounds[2], bounds[3]});
}

void expect_inside_walls(const SceneContent& content, double give_m) {
  const double half_width_m = Pit(content).half_width_m;
  for (const dGeomID geom : content.geoms) {
    if (dGeomGetBody(geom) == nullptr) continue;
    EXPECT_LE(farthest_corner_m(geom), half_width_m + give_m);
  }
}

TEST(RockPile, ComesToRestAboutAsDeepAsAsked) {
  for (const int depth : {1, 3, 6, 10}) {
    SceneWorld world(scene_named("rock_pile"), {{"bodies", "150"}, {"depth", std::to_string(depth)}});
    for (int step = 0; step < 250; ++step) world.step(step, 30);
    const Pit pit(world.content());
    RecordProperty("layers", std::to_string(pit.layers()));
    EXPECT_GT(pit.layers(), 0.7 * depth) << depth;
    EXPECT_LT(pit.layers(), 1.3 * depth + 0.5) << depth;
    std::printf("depth %d layers %g highest %g\n", depth, pit.layers(), pit.highest_m);
  }
}

TEST(Silo, IsAboutAsHighAsItIsWide) {
  for (const int bodies : {150, 500, 2000, 10000}) {
    SceneWorld world(scene_named("silo"), {{"bodies", std::to_string(bodies)}});
    const Pit pit(world.content());
    const double height_m = pit.highest_m + kMeanEdge_m / 2;
    std::printf("bodies %d height %g width %g contacts %d between %d\n", bodies, height_m,
                2 * pit.half_width_m, world.collide().all, world.collide().between_bodies);
    EXPECT_GT(height_m, (bodies < 1000 ? 0.7 : 0.9) * 2 * pit.half_width_m) << bodies;
    EXPECT_LT(height_m, (bodies < 1000 ? 1.4 : 1.1) * 2 * pit.half_width_m) << bodies;
    expect_inside_walls(world.content(), 0);
  }
}

TEST(Silo, StaysAsItWasBuilt) {
  SceneWorld world(scene_named("silo"), {{"bodies", "400"}});
  const SceneContent& content = world.content();
  std::vector<std::array<double, 3>> start;
  for (const dBodyID body : content.bodies) {
    const dReal* x = dBodyGetPosition(body);
    start.push_back({x[0], x[1], x[2]});
  }
  const double layers = Pit(content).layers();
  for (int step = 0; step < 120; ++step) {
    const SceneWorld::Contacts contacts = world.step(step, 50);
    if (step % 20 == 0)
      std::printf("step %d contacts %d depth %g\n", step, contacts.between_bodies, contacts.largest_depth_m);
  }
  double moved = 0;
  for (std::size_t i = 0; i < start.size(); ++i)
    for (int k = 0; k < 3; ++k)
      moved = std::max(moved, std::abs(dBodyGetPosition(content.bodies[i])[k] - start[i][k]));
  std::printf("moved %g layers %g -> %g\n", moved, layers, Pit(content).layers());
  expect_inside_walls(content, 0.01);
}

}  // namespace
}  // namespace cleave
