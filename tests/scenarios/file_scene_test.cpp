// Scenes that are written in a file put into the world what the file says.
#include <gtest/gtest.h>

#include <set>

#include "scenarios/shapes.h"
#include "scene_world.h"
#include "shipped_scenes.h"
#include "snapshot.h"
#include "written_scene.h"

namespace cleave {
namespace {

using Vector = std::array<double, 3>;

SceneWorld shipped(const std::string& name, std::uint64_t seed = 1) {
  return SceneWorld(scene_named("file"), {{"path", shipped_file(name)}}, seed);
}

SceneWorld written(const std::string& text, std::uint64_t seed = 1) {
  return SceneWorld(scene_named("file"), WrittenScene(text).given(), seed);
}

Vector position(dBodyID body) {
  const dReal* x = dBodyGetPosition(body);
  return {x[0], x[1], x[2]};
}

const std::string kBall = "[[body]]\nshape = 'sphere'\nradius_m = 0.5\nmass_kg = 2\n";

TEST(FileScene, ChainDropIsTheCompiledOneToTheLastBit) {
  SceneWorld file = shipped("chain_drop"), compiled(scene_named("chain_drop"), {});
  EXPECT_EQ(snapshot(file.content()), snapshot(compiled.content()));
  for (SceneWorld* world : {&file, &compiled}) {
    dRandSetSeed(1);  // QuickStep draws from it
    for (int step = 0; step < 100; ++step) world->step(step, 20);
  }
  EXPECT_EQ(snapshot(file.content()), snapshot(compiled.content()));
}

TEST(FileScene, LogTowerIsTheCompiledOneAndSoIsItsBall) {
  SceneWorld file = shipped("log_tower"), compiled(scene_named("log_tower"), {});
  EXPECT_EQ(snapshot(file.content()), snapshot(compiled.content()));
  for (SceneWorld* world : {&file, &compiled}) {
    dRandSetSeed(1);  // QuickStep draws from it
    for (int step = 0; step < 60; ++step) world->step(step, 10);
    EXPECT_EQ(speed_m_per_s(world->content().bodies.back()), 0);
    for (int step = 60; step < 80; ++step) world->step(step, 10);
    EXPECT_GT(speed_m_per_s(world->content().bodies.back()), 1);
  }
  EXPECT_EQ(snapshot(file.content()), snapshot(compiled.content()));
}

TEST(FileScene, PileHasTheDistributionsOfTheRockPile) {
  SceneWorld file = shipped("pile"), compiled(scene_named("rock_pile"), {});
  ASSERT_EQ(file.content().bodies.size(), compiled.content().bodies.size());
  ASSERT_EQ(file.content().geoms.size(), compiled.content().geoms.size());
  EXPECT_EQ(file.collide().all, 0);
  std::vector<double> edges_m;
  double mean[4]{}, off_m = 0;
  for (std::size_t i = 0; i < file.content().bodies.size(); ++i) {
    const dBodyID body = file.content().bodies[i], other = compiled.content().bodies[i];
    // Both stand off the same place of the grid, by up to 0.05 m along every axis.
    for (int k = 0; k < 3; ++k) off_m = std::max(off_m, std::abs(position(body)[k] - position(other)[k]));
    dMass mass;
    dBodyGetMass(body, &mass);
    EXPECT_EQ(mass.mass, 100);
    for (int k = 0; k < 4; ++k) mean[k] += std::pow(dBodyGetQuaternion(body)[k], 2) / 200;
    dVector3 lengths;
    dGeomBoxGetLengths(dBodyGetFirstGeom(body), lengths);
    edges_m.insert(edges_m.end(), lengths, lengths + 3);
  }
  EXPECT_LE(off_m, 0.1 + 1e-12);
  EXPECT_GT(off_m, 0.09);
  for (const double m : mean) EXPECT_NEAR(m, 0.25, 0.05);
  const auto [least, most] = std::ranges::minmax(edges_m);
  EXPECT_GE(least, 0.5);
  EXPECT_LT(least, 0.51);
  EXPECT_LT(most, 0.8);
  EXPECT_GT(most, 0.79);
  EXPECT_EQ(std::set<double>(edges_m.begin(), edges_m.end()).size(), edges_m.size());
}

TEST(FileScene, PitOfThePileIsThatOfTheRockPile) {
  SceneWorld file = shipped("pile"), compiled(scene_named("rock_pile"), {});
  for (int i = 0; i < 5; ++i) {
    dVector4 a, b;
    dGeomPlaneGetParams(file.content().geoms[i], a);
    dGeomPlaneGetParams(compiled.content().geoms[i], b);
    for (int k = 0; k < 4; ++k) EXPECT_DOUBLE_EQ(a[k], b[k]) << i;
  }
}

TEST(FileScene, RangesAreDrawnAnewForEveryBodyFromTheSeed) {
  const std::string text =
      "[[body]]\nshape = 'sphere'\nradius_m = { from = 0.1, to = 0.4 }\nmass_kg = { one_of = [1, 20] }\n"
      "position_m = [0, { from = -1, to = 1 }, 0]\ngrid = { count = [50, 2, 1], spacing_m = [1, 4, 0] }\n";
  SceneWorld world = written(text, 7), same = written(text, 7), other = written(text, 8);
  EXPECT_EQ(snapshot(world.content()), snapshot(same.content()));
  EXPECT_NE(snapshot(world.content()), snapshot(other.content()));
  std::set<double> radii_m, off_m;
  std::map<double, int> masses;
  for (std::size_t i = 0; i < 100; ++i) {
    const dBodyID body = world.content().bodies[i];
    radii_m.insert(dGeomSphereGetRadius(dBodyGetFirstGeom(body)));
    off_m.insert(position(body)[1] - (i < 50 ? -2 : 2));
    EXPECT_EQ(position(body)[2], 0);
    dMass mass;
    dBodyGetMass(body, &mass);
    ++masses[mass.mass];
  }
  EXPECT_EQ(radii_m.size(), 100u);
  EXPECT_GE(*radii_m.begin(), 0.1);
  EXPECT_LT(*radii_m.rbegin(), 0.4);
  EXPECT_GT(*radii_m.rbegin() - *radii_m.begin(), 0.27);
  EXPECT_EQ(off_m.size(), 100u);
  EXPECT_GE(*off_m.begin(), -1);
  EXPECT_LT(*off_m.rbegin(), 1);
  EXPECT_GT(*off_m.rbegin() - *off_m.begin(), 1.8);
  EXPECT_EQ(masses.size(), 2u);
  EXPECT_GT(masses[1], 30);
  EXPECT_GT(masses[20], 30);
}

TEST(FileScene, GridsAreCentredLevelAndGrowUpwards) {
  const SceneWorld world =
      written(kBall + "position_m = [10, 20, 30]\ngrid = { count = [3, 2, 2], spacing_m = [1, 2, 4] }\n");
  std::vector<Vector> found;
  for (const dBodyID body : world.content().bodies) found.push_back(position(body));
  const std::vector<Vector> wanted = {{9, 19, 30},  {10, 19, 30}, {11, 19, 30}, {9, 21, 30},
                                      {10, 21, 30}, {11, 21, 30}, {9, 19, 34},  {10, 19, 34},
                                      {11, 19, 34}, {9, 21, 34},  {10, 21, 34}, {11, 21, 34}};
  EXPECT_EQ(found, wanted);
}

TEST(FileScene, EveryShapeIsTheBuildersOwn) {
  SceneWorld file = written(R"(
[ground]
height_m = -3
[[plane]]
normal = [0, 3, 4]
offset_m = -7
[[body]]
shape = "sphere"
radius_m = 0.5
mass_kg = 2
position_m = [0, 0, 0]
[[body]]
shape = "box"
edges_m = [0.5, 0.6, 0.7]
mass_kg = 3
position_m = [2, 0, 0]
orientation = [0.6, 0, 0.8, 0]
[[body]]
shape = "capsule"
radius_m = 0.2
length_m = 0.7
mass_kg = 4
position_m = [4, 0, 0]
along = [1, 2, 3]
velocity_m_per_s = [1, 2, 3]
angular_velocity_rad_per_s = [4, 5, 6]
[[body]]
shape = "cylinder"
radius_m = 0.3
length_m = 0.8
mass_kg = 5
position_m = [6, 0, 0]
gravity = false
[[body]]
shape = "clump"
spheres = [{ centre_m = [0, 0, 0], radius_m = 0.2 }, { centre_m = [0.3, 0, 0], radius_m = 0.1 }]
mass_kg = 9
position_m = [8, 0, 0]
[[body]]
shape = "convex"
edges_m = [0.5, 0.6, 0.7]
taper = [0.1, 0.2, 0.3]
mass_kg = 6
position_m = [10, 0, 0]
)");
  const dWorldID world = dWorldCreate();
  const dSpaceID space = dSimpleSpaceCreate(nullptr);
  SceneBuilder builder(world, space);
  builder.add_plane({0, 0, 1}, -3);
  builder.add_plane({0, 0.6, 0.8}, -7);
  builder.add_sphere({{0, 0, 0}}, 2, 0.5);
  builder.add_box({{2, 0, 0}, {0.6, 0, 0.8, 0}}, 3, {0.5, 0.6, 0.7});
  const dBodyID moving = builder.add_capsule({{4, 0, 0}, orientation_along({1, 2, 3})}, 4, 0.2, 0.7);
  dBodySetLinearVel(moving, 1, 2, 3);
  dBodySetAngularVel(moving, 4, 5, 6);
  dBodySetGravityMode(builder.add_cylinder({{6, 0, 0}}, 5, 0.3, 0.8), 0);
  const ClumpSphere spheres[] = {{{0, 0, 0}, 0.2}, {{0.3, 0, 0}, 0.1}};
  builder.add_clump({{8, 0, 0}}, 9, spheres);
  const ConvexHull hull = make_tapered_box({0.5, 0.6, 0.7}, {0.1, 0.2, 0.3});
  builder.add_convex({{10, 0, 0}}, 6, hull);
  const SceneContent by_hand = builder.take();
  EXPECT_EQ(snapshot(file.content()), snapshot(by_hand));
  ASSERT_EQ(file.content().convex_corners.size(), 1u);
  EXPECT_TRUE(std::ranges::equal(file.content().convex_corners.begin()->second,
                                 by_hand.convex_corners.begin()->second));
  dSpaceDestroy(space);
  dWorldDestroy(world);
}

const std::string kFourBoxes =
    "[[body]]\ngroup = 'box'\nshape = 'box'\nedges_m = [1, 1, 1]\nmass_kg = 1\nposition_m = [0, 0, 0]\n"
    "grid = { count = [4, 1, 1], spacing_m = [2, 0, 0] }\n"
    "[[body]]\ngroup = 'top'\nshape = 'box'\nedges_m = [1, 1, 1]\nmass_kg = 1\nposition_m = [0, 0, 5]\n";

TEST(FileScene, EveryJointIsTheOneMadeByHand) {
  SceneWorld file = written(kFourBoxes + R"(
[[joint]]
kind = "ball"
bodies = ["box[0]", "box[1]"]
anchor_m = [-2, 0.1, 0]
[[joint]]
kind = "hinge"
bodies = ["box[1]", "box[2]"]
anchor_m = [0, 0.2, 0]
axis = [1, 2, 2]
[[joint]]
kind = "slider"
bodies = ["box[3]", "box[2]"]
axis = [3, 4, 0]
[[joint]]
kind = "fixed"
bodies = ["box[3]", "top"]
[[joint]]
kind = "hinge"
bodies = ["top", "world"]
anchor_m = [0, 0, 6]
axis = [0, 1, 0]
)");
  SceneWorld same = written(kFourBoxes);
  const std::vector<dBodyID>& b = same.content().bodies;
  SceneContent by_hand = same.content();
  const dWorldID world = dBodyGetWorld(b[0]);
  const auto join = [&](dJointID joint, dBodyID first, dBodyID second) {
    dJointAttach(joint, first, second);
    by_hand.joints.push_back(joint);
    return joint;
  };
  dJointSetBallAnchor(join(dJointCreateBall(world, nullptr), b[0], b[1]), -2, 0.1, 0);
  const dJointID hinge = join(dJointCreateHinge(world, nullptr), b[1], b[2]);
  dJointSetHingeAnchor(hinge, 0, 0.2, 0);
  dJointSetHingeAxis(hinge, 1, 2, 2);
  dJointSetSliderAxis(join(dJointCreateSlider(world, nullptr), b[3], b[2]), 3, 4, 0);
  dJointSetFixed(join(dJointCreateFixed(world, nullptr), b[3], b[4]));
  const dJointID door = join(dJointCreateHinge(world, nullptr), b[4], nullptr);
  dJointSetHingeAnchor(door, 0, 0, 6);
  dJointSetHingeAxis(door, 0, 1, 0);
  ASSERT_EQ(file.content().joints.size(), 5u);
  EXPECT_EQ(snapshot(file.content()), snapshot(by_hand));
  for (SceneWorld* stepped : {&file, &same}) {
    dRandSetSeed(1);  // QuickStep draws from it
    for (int step = 0; step < 30; ++step) stepped->step(step, 20);
  }
  EXPECT_EQ(snapshot(file.content()), snapshot(by_hand));
  EXPECT_LT(position(file.content().bodies[0])[2], -0.1);
}

TEST(FileScene, RowsOfPointsAreJoinedAtThePointsBetween) {
  for (const std::string kind : {"kind = 'ball'", "kind = 'hinge', axis = [0, 1, 0]", "kind = 'fixed'"}) {
    const SceneWorld world =
        written("[[body]]\nshape = 'cylinder'\nradius_m = 0.1\nlength_m = 0.8\nmass_kg = 1\njoined_by = { " +
                kind + " }\nthrough_m = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [1, 1, 3]]\n");
    const SceneContent& content = world.content();
    ASSERT_EQ(content.bodies.size(), 3u);
    ASSERT_EQ(content.joints.size(), 2u);
    EXPECT_EQ(position(content.bodies[0]), (Vector{0.5, 0, 0}));
    EXPECT_EQ(position(content.bodies[2]), (Vector{1, 1, 1.5}));
    EXPECT_NEAR(dBodyGetRotation(content.bodies[1])[6], 1, 1e-15);  // its z axis lies along the world's y
    for (int i = 0; i < 2; ++i) {
      EXPECT_EQ(dJointGetBody(content.joints[i], 0), content.bodies[i]);
      EXPECT_EQ(dJointGetBody(content.joints[i], 1), content.bodies[i + 1]);
    }
    dVector3 anchor;
    if (kind == "kind = 'ball'") {
      dJointGetBallAnchor(content.joints[1], anchor);
      EXPECT_NEAR(anchor[0] + 10 * anchor[1] + 100 * anchor[2], 11, 1e-12);
    }
  }
}

TEST(FileScene, EveryBodyKnowsItsGroup) {
  const SceneWorld world = written(kFourBoxes + kBall + "position_m = [9, 9, 9]\n");
  EXPECT_EQ(world.content().body_group, (std::vector<std::string>{"box", "box", "box", "box", "top", ""}));
  SceneWorld compiled(scene_named("chain_drop"), {});
  EXPECT_TRUE(compiled.content().body_group.empty());
}

TEST(FileScene, EventsChangeWhatTheyNameAtTheirStep) {
  SceneWorld world = written(kFourBoxes + R"(
[[event]]
step = 3
bodies = "box"
gravity = false
velocity_m_per_s = [{ from = 1, to = 2 }, 0, 0]
[[event]]
step = 3
bodies = "box[2]"
angular_velocity_rad_per_s = [0, 0, 5]
[[event]]
step = 4
bodies = "box[2]"
gravity = true
)");
  const std::vector<dBodyID>& bodies = world.content().bodies;
  for (int step = 0; step < 3; ++step) world.step(step, 20);
  for (const dBodyID body : bodies) EXPECT_NEAR(dBodyGetLinearVel(body)[2], -9.81 * 3 / 60, 1e-12);
  world.step(3, 20);
  std::set<double> speeds;
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(dBodyGetLinearVel(bodies[i])[2], 0);
    EXPECT_NEAR(dBodyGetAngularVel(bodies[i])[2], i == 2 ? 5 : 0, 1e-12);
    speeds.insert(dBodyGetLinearVel(bodies[i])[0]);
  }
  EXPECT_EQ(speeds.size(), 4u);
  EXPECT_GE(*speeds.begin(), 1);
  EXPECT_LT(*speeds.rbegin(), 2);
  EXPECT_NEAR(dBodyGetLinearVel(bodies[4])[2], -9.81 * 4 / 60, 1e-12);
  world.step(4, 20);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(dBodyGetLinearVel(bodies[i])[2] < 0, i == 2) << i;
}

TEST(FileScene, ContactLayerIsTheWorlds) {
  const SceneWorld world = written("contact_layer_m = 1e-4\n" + kBall + "position_m = [0, 0, 0]\n");
  EXPECT_EQ(dWorldGetContactSurfaceLayer(dBodyGetWorld(world.content().bodies[0])), 1e-4);
}

// What was checked is what is built, and what the run's identity is made from.
TEST(FileScene, IsReadOnce) {
  const WrittenScene file(kBall + "position_m = [0, 0, 1]\n");
  SceneWorld before(scene_named("file"), file.given());
  const Settings settings = make_scene_settings(scene_named("file"), file.given());
  const std::string id = scene_content_id(scene_named("file"), settings);
  file.write("nonsense");
  SceneWorld after(scene_named("file"), file.given());
  EXPECT_EQ(snapshot(before.content()), snapshot(after.content()));
  EXPECT_EQ(scene_content_id(scene_named("file"), settings), id);
}

TEST(FileScene, IdentityIsTheContentNotThePath) {
  const auto id_of = [](const std::string& text) {
    const WrittenScene file(text);
    return scene_content_id(scene_named("file"), make_scene_settings(scene_named("file"), file.given()));
  };
  const std::string text = kBall + "position_m = [0, 0, 1]\n";
  EXPECT_EQ(id_of(text), id_of(text));
  EXPECT_NE(id_of(text), id_of(text + "# one more byte"));
  std::uint64_t hash = 14695981039346656037u;
  for (const unsigned char c : text) hash = (hash ^ c) * 1099511628211u;
  char hex[17];
  std::snprintf(hex, sizeof hex, "%016llx", static_cast<unsigned long long>(hash));
  EXPECT_EQ(id_of(text), hex);
  EXPECT_EQ(scene_content_id(scene_named("rock_pile"), make_scene_settings(scene_named("rock_pile"), {})),
            "");
}

}  // namespace
}  // namespace cleave
