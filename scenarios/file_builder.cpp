#include "scenarios/file_builder.h"

namespace cleave::scene_file {
namespace {

// Where body i of a grid lies, off the position that all of them have.
Vector grid_offset(const Grid& grid, int i) {
  const int column = i % grid.count[0], row = i / grid.count[0] % grid.count[1];
  const int layer = i / (grid.count[0] * grid.count[1]);
  return {(column - (grid.count[0] - 1) / 2.0) * grid.spacing_m[0],
          (row - (grid.count[1] - 1) / 2.0) * grid.spacing_m[1], layer * grid.spacing_m[2]};
}

Pose pose_between(const Vector& a, const Vector& b) {
  return {{(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2},
          orientation_along({b[0] - a[0], b[1] - a[1], b[2] - a[2]})};
}

Pose draw_pose(const Bodies& bodies, int i, SceneRandom& random) {
  if (!bodies.through_m.empty()) return pose_between(bodies.through_m[i], bodies.through_m[i + 1]);
  Pose pose{draw(bodies.position_m, random), bodies.orientation};
  const Vector offset = grid_offset(bodies.grid, i);
  for (int k = 0; k < 3; ++k) pose.position_m[k] += offset[k];
  if (bodies.random_orientation) pose.orientation = random.rotation();
  return pose;
}

void draw_motion(const Bodies& bodies, dBodyID body, SceneRandom& random) {
  const Vector v = draw(bodies.velocity_m_per_s, random);
  const Vector w = draw(bodies.angular_velocity_rad_per_s, random);
  dBodySetLinearVel(body, v[0], v[1], v[2]);
  dBodySetAngularVel(body, w[0], w[1], w[2]);
  dBodySetGravityMode(body, bodies.gravity);
}

// Returns what it added.
std::vector<dBodyID> add(SceneBuilder& builder, const Bodies& bodies, SceneRandom& random, Hulls& hulls) {
  std::vector<dBodyID> added;
  for (int i = 0; i < bodies.count(); ++i) {
    const Pose pose = draw_pose(bodies, i, random);
    const DrawnSize size = draw(bodies.size, random);
    const double mass_kg = bodies.mass_kg.draw(random);
    const dBodyID body = bodies.shape->add(builder, pose, mass_kg, size, hulls);
    draw_motion(bodies, body, random);
    if (bodies.joined_by && i > 0)
      bodies.joined_by->kind->add(builder, added.back(), body, bodies.through_m[i], bodies.joined_by->axis);
    added.push_back(body);
  }
  return added;
}

}  // namespace

SceneContent build(const Description& scene, dWorldID world, dSpaceID space, SceneRandom& random,
                   Hulls& hulls) {
  SceneBuilder builder(world, space);
  dWorldSetContactSurfaceLayer(world, scene.contact_layer_m);
  if (scene.pit_half_width_m > 0) builder.add_square_pit(scene.pit_half_width_m);
  for (const Plane& plane : scene.planes) builder.add_plane(plane.normal, plane.offset_m);
  std::vector<dBodyID> all;
  std::vector<std::string> groups;
  for (const Bodies& bodies : scene.bodies) {
    const std::vector<dBodyID> added = add(builder, bodies, random, hulls);
    all.insert(all.end(), added.begin(), added.end());
    groups.resize(all.size(), bodies.group);
  }
  for (const Joint& joint : scene.joints)
    joint.kind->add(builder, all[joint.body_a], joint.body_b < 0 ? nullptr : all[joint.body_b],
                    joint.anchor_m, joint.axis);
  SceneContent content = builder.take();
  content.body_group = std::move(groups);
  return content;
}

}  // namespace cleave::scene_file
