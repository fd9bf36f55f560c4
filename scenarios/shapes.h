// Bodies with their geometry, mass and inertia, and static planes: what scenes are made of.
//
// Every solid is of uniform density and has the given total mass in kg. Lengths are in metres. Capsules and
// cylinders lie along the z axis of their own frame. A body's origin is its centre of mass, as ODE demands.
#pragma once

#include <ode/ode.h>

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "scenarios/scene.h"

namespace cleave {

struct Pose {
  std::array<double, 3> position_m{};
  std::array<double, 4> orientation{1, 0, 0, 0};  // quaternion w x y z
};

// The shortest rotation that takes the z axis into a direction (any length but zero).
std::array<double, 4> orientation_along(const std::array<double, 3>& direction);

struct ClumpSphere {
  std::array<double, 3> centre_m{};
  double radius_m = 0;
};

// A box with six flat but slanting faces, as ODE's convex geometry wants it. Built by make_tapered_box; ODE
// reads the arrays as long as the geometry lives.
struct ConvexHull {
  std::array<dReal, 24> points;  // 8 corners, m
  std::array<dReal, 24> planes;  // 6 faces: outward unit normal, distance of the face from the origin
  static const unsigned int polygons[30];  // 6 faces: 4, then its corners anticlockwise seen from outside
};

// The corners s / 2 (signs s_k = +-1) of the unit cube are divided by 1 + sum_k taper_k (1 + s_k) / 2, which
// narrows the cube towards its positive sides, then stretched along each axis until they span a box with
// these edges about the origin. A projective map: faces stay flat and the solid convex. taper_k in [0, 1].
ConvexHull make_tapered_box(const std::array<double, 3>& edges_m, const std::array<double, 3>& taper);

// Mass, centre of mass and inertia about the origin of the hull, as a sum over the tetrahedra that join the
// origin to the triangles of the faces: for corners a, b, c and volume V = a.(b x c)/6, s = a + b + c,
//     integral x dV = V s / 4,   integral x x^T dV = V (a a^T + b b^T + c c^T + s s^T) / 20.
dMass hull_mass(const ConvexHull& hull, double mass_kg);

// Overlapping parts of a clump count once for each sphere in it, as usual for sphere clumps; masses go with
// volumes.
dMass clump_mass(std::span<const ClumpSphere> spheres, double mass_kg);

// Puts bodies into a world and enters them in the lists of SceneContent. The pose of a clump or hull is that
// of the frame its spheres or corners are given in.
class SceneBuilder {
 public:
  SceneBuilder(dWorldID world, dSpaceID space) : world_(world), space_(space) {}

  dBodyID add_sphere(const Pose& pose, double mass_kg, double radius_m);
  // copies: coincident boxes on the body. Each touches what is there by itself, so that every contact is
  // reported once per pair of copies.
  dBodyID add_box(const Pose& pose, double mass_kg, const std::array<double, 3>& edges_m, int copies = 1);
  // length_m: of the cylindrical part; the round ends come on top.
  dBodyID add_capsule(const Pose& pose, double mass_kg, double radius_m, double length_m);
  dBodyID add_cylinder(const Pose& pose, double mass_kg, double radius_m, double length_m);
  dBodyID add_clump(const Pose& pose, double mass_kg, std::span<const ClumpSphere> spheres);
  // hull: must outlive the geometry.
  dBodyID add_convex(const Pose& pose, double mass_kg, const ConvexHull& hull);
  // b: nullptr for the static environment. axis: any length but zero.
  void add_ball_joint(dBodyID a, dBodyID b, const std::array<double, 3>& anchor_m);
  dJointID add_hinge_joint(dBodyID a, dBodyID b, const std::array<double, 3>& anchor_m,
                           const std::array<double, 3>& axis);
  dJointID add_slider_joint(dBodyID a, dBodyID b, const std::array<double, 3>& axis);
  void add_fixed_joint(dBodyID a, dBodyID b);
  // Static: everything with normal . x < offset_m is solid. normal: unit.
  void add_plane(const std::array<double, 3>& normal, double offset_m);
  // A floor at z = 0 and four walls without end at x, y = +-half_width_m.
  void add_square_pit(double half_width_m);

  int body_count() const { return static_cast<int>(content_.bodies.size()); }

  SceneContent take() { return std::move(content_); }

 private:
  struct PlacedGeom {
    dGeomID geom;
    std::array<double, 3> origin_m;  // in the frame of the pose
  };
  dBodyID add_body(const Pose& pose, dMass mass, std::span<const PlacedGeom> geoms);

  dWorldID world_;
  dSpaceID space_;
  SceneContent content_;
};

}  // namespace cleave
