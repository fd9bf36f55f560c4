#include "scenarios/ladder_loop.h"

#include <cmath>
#include <numbers>

#include "scenarios/shapes.h"

namespace cleave {
namespace {

using Vector = std::array<double, 3>;

constexpr double kMass_kg = 1;
constexpr double kRadius_m = 0.05;
constexpr double kLength_m = 0.4;
constexpr Vector kAxis{2, 3, 6};  // of every hinge; of length 7, and along no axis of the world

// Corners of a regular polygon in the plane across kAxis, from the one at the origin, which it hangs by.
std::vector<Vector> corners(int links) {
  const Vector e1{3.0 / 7, -6.0 / 7, 2.0 / 7}, e2{6.0 / 7, 2.0 / 7, -3.0 / 7};
  const double radius_m = kLength_m / (2 * std::sin(std::numbers::pi / links));
  std::vector<Vector> points;
  for (int i = 0; i < links; ++i) {
    const double angle_rad = 2 * std::numbers::pi * i / links;
    const double x = radius_m * (std::cos(angle_rad) - 1), y = radius_m * std::sin(angle_rad);
    Vector& point = points.emplace_back();
    for (int k = 0; k < 3; ++k) point[k] = x * e1[k] + y * e2[k];
  }
  return points;
}

class LadderLoop : public Scene {
 public:
  SceneContent build(dWorldID world, dSpaceID space, const Settings& settings, std::uint64_t) override {
    SceneBuilder builder(world, space);
    const std::vector<Vector> points = corners(settings.integer("links"));
    std::vector<dBodyID> links;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vector &a = points[i], &b = points[(i + 1) % points.size()];
      const Pose pose{{(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2},
                      orientation_along({b[0] - a[0], b[1] - a[1], b[2] - a[2]})};
      links.push_back(builder.add_capsule(pose, kMass_kg, kRadius_m, kLength_m));
    }
    builder.add_hinge_joint(links.front(), nullptr, points.front(), kAxis);
    for (std::size_t i = 0; i < links.size(); ++i)
      builder.add_hinge_joint(links[i], links[(i + 1) % links.size()], points[(i + 1) % points.size()],
                              kAxis);
    return builder.take();
  }
};

}  // namespace

std::vector<Parameter> ladder_loop_parameters() {
  return {{"links", Parameter::Kind::integer, "6", {3, 1000}, {}, "", "number of links"}};
}

std::unique_ptr<Scene> make_ladder_loop() { return std::make_unique<LadderLoop>(); }

}  // namespace cleave
