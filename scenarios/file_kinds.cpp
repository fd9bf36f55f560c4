#include "scenarios/file_kinds.h"

namespace cleave::scene_file {

DrawnSize draw(const Size& size, SceneRandom& random) {
  DrawnSize drawn{};
  drawn.radius_m = size.radius_m.draw(random);
  drawn.length_m = size.length_m.draw(random);
  drawn.edges_m = draw(size.edges_m, random);
  drawn.taper = draw(size.taper, random);
  for (const SphereOfClump& sphere : size.spheres) {
    const std::array<double, 3> centre_m = draw(sphere.centre_m, random);
    drawn.spheres.push_back({centre_m, sphere.radius_m.draw(random)});
  }
  return drawn;
}

std::span<const ShapeKind> shape_kinds() {
  static const ShapeKind table[] = {
      {"sphere",
       {"radius_m"},
       [](SceneBuilder& b, const Pose& pose, double mass_kg, const DrawnSize& size, Hulls&) {
         return b.add_sphere(pose, mass_kg, size.radius_m);
       }},
      {"box",
       {"edges_m"},
       [](SceneBuilder& b, const Pose& pose, double mass_kg, const DrawnSize& size, Hulls&) {
         return b.add_box(pose, mass_kg, size.edges_m);
       }},
      {"capsule",
       {"radius_m", "length_m"},
       [](SceneBuilder& b, const Pose& pose, double mass_kg, const DrawnSize& size, Hulls&) {
         return b.add_capsule(pose, mass_kg, size.radius_m, size.length_m);
       }},
      {"cylinder",
       {"radius_m", "length_m"},
       [](SceneBuilder& b, const Pose& pose, double mass_kg, const DrawnSize& size, Hulls&) {
         return b.add_cylinder(pose, mass_kg, size.radius_m, size.length_m);
       }},
      {"clump",
       {"spheres"},
       [](SceneBuilder& b, const Pose& pose, double mass_kg, const DrawnSize& size, Hulls&) {
         return b.add_clump(pose, mass_kg, size.spheres);
       }},
      {"convex",
       {"edges_m", "taper"},
       [](SceneBuilder& b, const Pose& pose, double mass_kg, const DrawnSize& size, Hulls& hulls) {
         return b.add_convex(pose, mass_kg, hulls.emplace_back(make_tapered_box(size.edges_m, size.taper)));
       }},
  };
  return table;
}

std::span<const JointKind> joint_kinds() {
  using Vector = std::array<double, 3>;
  static const JointKind table[] = {
      {"ball",
       {"anchor_m"},
       [](SceneBuilder& builder, dBodyID a, dBodyID b, const Vector& anchor_m, const Vector&) {
         builder.add_ball_joint(a, b, anchor_m);
       }},
      {"hinge",
       {"anchor_m", "axis"},
       [](SceneBuilder& builder, dBodyID a, dBodyID b, const Vector& anchor_m, const Vector& axis) {
         builder.add_hinge_joint(a, b, anchor_m, axis);
       }},
      {"slider",
       {"axis"},
       [](SceneBuilder& builder, dBodyID a, dBodyID b, const Vector&, const Vector& axis) {
         builder.add_slider_joint(a, b, axis);
       }},
      {"fixed",
       {},
       [](SceneBuilder& builder, dBodyID a, dBodyID b, const Vector&, const Vector&) {
         builder.add_fixed_joint(a, b);
       }},
  };
  return table;
}

}  // namespace cleave::scene_file
