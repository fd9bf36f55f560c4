#include "scenarios/shapes.h"

#include <cassert>
#include <cmath>

namespace cleave {
namespace {

using Vector = std::array<double, 3>;

constexpr int kAlongZ = 3;

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector minus(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

Vector corner(const ConvexHull& hull, unsigned int index) {
  return {hull.points[3 * index], hull.points[3 * index + 1], hull.points[3 * index + 2]};
}

// Sums volume, integral x and integral x x^T of the tetrahedron between the origin and a triangle.
struct VolumeIntegrals {
  double volume = 0;
  Vector first{};
  double second[3][3]{};

  void add(const Vector& a, const Vector& b, const Vector& c) {
    const double v = dot(a, cross(b, c)) / 6;
    const Vector s{a[0] + b[0] + c[0], a[1] + b[1] + c[1], a[2] + b[2] + c[2]};
    volume += v;
    for (int i = 0; i < 3; ++i) {
      first[i] += v * s[i] / 4;
      for (int j = 0; j < 3; ++j)
        second[i][j] += v * (a[i] * a[j] + b[i] * b[j] + c[i] * c[j] + s[i] * s[j]) / 20;
    }
  }
};

}  // namespace

std::array<double, 4> orientation_along(const Vector& direction) {
  const double length = std::sqrt(dot(direction, direction));
  assert(length > 0);
  const Vector d{direction[0] / length, direction[1] / length, direction[2] / length};
  if (d[2] < -1 + 1e-12) return {0, 1, 0, 0};
  // (1 + z.d, z x d), normalised, is the half-way rotation.
  const double norm = std::sqrt(2 * (1 + d[2]));
  return {norm / 2, -d[1] / norm, d[0] / norm, 0};
}

// Corner bits: 1 = +x, 2 = +y, 4 = +z.
const unsigned int ConvexHull::polygons[30] = {4, 1, 3, 7, 5, 4, 0, 4, 6, 2, 4, 2, 6, 7, 3,
                                               4, 0, 1, 5, 4, 4, 4, 5, 7, 6, 4, 0, 2, 3, 1};

ConvexHull make_tapered_box(const Vector& edges_m, const Vector& taper) {
  ConvexHull hull;
  for (unsigned int c = 0; c < 8; ++c) {
    double weight = 1;
    for (int k = 0; k < 3; ++k) weight += (c >> k & 1) ? taper[k] : 0;
    for (int k = 0; k < 3; ++k) {
      const double from_low_side = ((c >> k & 1) ? 0.5 : -0.5) / weight + 0.5;
      const double stretch = 2 * (1 + taper[k]) / (2 + taper[k]);
      hull.points[3 * c + k] = edges_m[k] * (from_low_side * stretch - 0.5);
    }
  }
  for (int f = 0; f < 6; ++f) {
    const unsigned int* face = ConvexHull::polygons + 5 * f + 1;
    const Vector origin = corner(hull, face[0]);
    const Vector normal = cross(minus(corner(hull, face[1]), origin), minus(corner(hull, face[2]), origin));
    const double length = std::sqrt(dot(normal, normal));
    for (int k = 0; k < 3; ++k) hull.planes[4 * f + k] = normal[k] / length;
    hull.planes[4 * f + 3] = dot(normal, origin) / length;
  }
  return hull;
}

dMass hull_mass(const ConvexHull& hull, double mass_kg) {
  VolumeIntegrals sum;
  for (int f = 0; f < 6; ++f) {
    const unsigned int* face = ConvexHull::polygons + 5 * f + 1;
    const Vector a = corner(hull, face[0]), c = corner(hull, face[2]);
    sum.add(a, corner(hull, face[1]), c);
    sum.add(a, c, corner(hull, face[3]));
  }
  const double density = mass_kg / sum.volume;
  const auto& s = sum.second;
  dMass mass;
  dMassSetParameters(&mass, mass_kg, sum.first[0] / sum.volume, sum.first[1] / sum.volume,
                     sum.first[2] / sum.volume, density * (s[1][1] + s[2][2]), density * (s[0][0] + s[2][2]),
                     density * (s[0][0] + s[1][1]), -density * s[0][1], -density * s[0][2],
                     -density * s[1][2]);
  return mass;
}

dMass clump_mass(std::span<const ClumpSphere> spheres, double mass_kg) {
  double cubes = 0;
  for (const ClumpSphere& sphere : spheres) cubes += std::pow(sphere.radius_m, 3);
  dMass mass;
  dMassSetZero(&mass);
  for (const ClumpSphere& sphere : spheres) {
    dMass part;
    dMassSetSphereTotal(&part, mass_kg * std::pow(sphere.radius_m, 3) / cubes, sphere.radius_m);
    dMassTranslate(&part, sphere.centre_m[0], sphere.centre_m[1], sphere.centre_m[2]);
    dMassAdd(&mass, &part);
  }
  return mass;
}

dBodyID SceneBuilder::add_body(const Pose& pose, dMass mass, std::span<const PlacedGeom> geoms) {
  const dBodyID body = dBodyCreate(world_);
  const Vector centre{mass.c[0], mass.c[1], mass.c[2]};
  dBodySetQuaternion(body, pose.orientation.data());
  dBodySetPosition(body, pose.position_m[0], pose.position_m[1], pose.position_m[2]);
  dVector3 world_centre;
  dBodyGetRelPointPos(body, centre[0], centre[1], centre[2], world_centre);
  dBodySetPosition(body, world_centre[0], world_centre[1], world_centre[2]);
  dMassTranslate(&mass, -centre[0], -centre[1], -centre[2]);
  // ODE asks for a centre at exactly zero; the translation leaves a rounding error.
  mass.c[0] = mass.c[1] = mass.c[2] = 0;
  dBodySetMass(body, &mass);
  content_.bodies.push_back(body);
  for (const PlacedGeom& placed : geoms) {
    dGeomSetBody(placed.geom, body);
    const Vector offset = minus(placed.origin_m, centre);
    if (offset != Vector{}) dGeomSetOffsetPosition(placed.geom, offset[0], offset[1], offset[2]);
    content_.geoms.push_back(placed.geom);
  }
  return body;
}

dBodyID SceneBuilder::add_sphere(const Pose& pose, double mass_kg, double radius_m) {
  dMass mass;
  dMassSetSphereTotal(&mass, mass_kg, radius_m);
  return add_body(pose, mass, {{PlacedGeom{dCreateSphere(space_, radius_m), {}}}});
}

dBodyID SceneBuilder::add_box(const Pose& pose, double mass_kg, const Vector& edges_m, int copies) {
  dMass mass;
  dMassSetBoxTotal(&mass, mass_kg, edges_m[0], edges_m[1], edges_m[2]);
  std::vector<PlacedGeom> geoms;
  for (int i = 0; i < copies; ++i)
    geoms.push_back({dCreateBox(space_, edges_m[0], edges_m[1], edges_m[2]), {}});
  return add_body(pose, mass, geoms);
}

dBodyID SceneBuilder::add_capsule(const Pose& pose, double mass_kg, double radius_m, double length_m) {
  dMass mass;
  dMassSetCapsuleTotal(&mass, mass_kg, kAlongZ, radius_m, length_m);
  return add_body(pose, mass, {{PlacedGeom{dCreateCapsule(space_, radius_m, length_m), {}}}});
}

dBodyID SceneBuilder::add_cylinder(const Pose& pose, double mass_kg, double radius_m, double length_m) {
  dMass mass;
  dMassSetCylinderTotal(&mass, mass_kg, kAlongZ, radius_m, length_m);
  return add_body(pose, mass, {{PlacedGeom{dCreateCylinder(space_, radius_m, length_m), {}}}});
}

dBodyID SceneBuilder::add_clump(const Pose& pose, double mass_kg, std::span<const ClumpSphere> spheres) {
  std::vector<PlacedGeom> geoms;
  for (const ClumpSphere& sphere : spheres)
    geoms.push_back({dCreateSphere(space_, sphere.radius_m), sphere.centre_m});
  return add_body(pose, clump_mass(spheres, mass_kg), geoms);
}

dBodyID SceneBuilder::add_convex(const Pose& pose, double mass_kg, const ConvexHull& hull) {
  const dGeomID geom =
      dCreateConvex(space_, hull.planes.data(), 6, hull.points.data(), 8, ConvexHull::polygons);
  content_.convex_corners[static_cast<int>(content_.geoms.size())] = hull.points;
  return add_body(pose, hull_mass(hull, mass_kg), {{PlacedGeom{geom, {}}}});
}

void SceneBuilder::add_ball_joint(dBodyID a, dBodyID b, const Vector& anchor_m) {
  const dJointID joint = dJointCreateBall(world_, nullptr);
  dJointAttach(joint, a, b);
  dJointSetBallAnchor(joint, anchor_m[0], anchor_m[1], anchor_m[2]);
  content_.joints.push_back(joint);
}

dJointID SceneBuilder::add_hinge_joint(dBodyID a, dBodyID b, const Vector& anchor_m, const Vector& axis) {
  const dJointID joint = dJointCreateHinge(world_, nullptr);
  dJointAttach(joint, a, b);
  dJointSetHingeAnchor(joint, anchor_m[0], anchor_m[1], anchor_m[2]);
  dJointSetHingeAxis(joint, axis[0], axis[1], axis[2]);
  content_.joints.push_back(joint);
  return joint;
}

dJointID SceneBuilder::add_slider_joint(dBodyID a, dBodyID b, const Vector& axis) {
  const dJointID joint = dJointCreateSlider(world_, nullptr);
  dJointAttach(joint, a, b);
  dJointSetSliderAxis(joint, axis[0], axis[1], axis[2]);
  content_.joints.push_back(joint);
  return joint;
}

void SceneBuilder::add_fixed_joint(dBodyID a, dBodyID b) {
  const dJointID joint = dJointCreateFixed(world_, nullptr);
  dJointAttach(joint, a, b);
  dJointSetFixed(joint);
  content_.joints.push_back(joint);
}

void SceneBuilder::add_plane(const Vector& normal, double offset_m) {
  content_.geoms.push_back(dCreatePlane(space_, normal[0], normal[1], normal[2], offset_m));
}

void SceneBuilder::add_square_pit(double half_width_m) {
  add_plane({0, 0, 1}, 0);
  add_plane({1, 0, 0}, -half_width_m);
  add_plane({-1, 0, 0}, -half_width_m);
  add_plane({0, 1, 0}, -half_width_m);
  add_plane({0, -1, 0}, -half_width_m);
}

}  // namespace cleave
