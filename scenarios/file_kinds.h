// The shapes and joints that a scene file may name: one row each, with the keys it reads and how it is built.
#pragma once

#include <array>
#include <deque>
#include <span>
#include <string>
#include <vector>

#include "scenarios/file_number.h"
#include "scenarios/shapes.h"

namespace cleave::scene_file {

struct SphereOfClump {
  DrawnVector centre_m{};
  Number radius_m;
};

// What the keys of all shapes hold; a shape leaves those of others at zero.
struct Size {
  Number radius_m, length_m;
  DrawnVector edges_m{}, taper{};
  std::vector<SphereOfClump> spheres;
};

struct DrawnSize {
  double radius_m, length_m;
  std::array<double, 3> edges_m, taper;
  std::vector<ClumpSphere> spheres;
};

// In the order of the members.
DrawnSize draw(const Size& size, SceneRandom& random);

// Hulls must stay where they are as long as the world lives.
using Hulls = std::deque<ConvexHull>;

struct ShapeKind {
  const char* name;
  std::vector<std::string> keys;  // of its size, all required
  dBodyID (*add)(SceneBuilder&, const Pose&, double mass_kg, const DrawnSize&, Hulls&);
};

std::span<const ShapeKind> shape_kinds();

struct JointKind {
  const char* name;
  std::vector<std::string> keys;  // of its geometry, all required
  void (*add)(SceneBuilder&, dBodyID a, dBodyID b, const std::array<double, 3>& anchor_m,
              const std::array<double, 3>& axis);
};

std::span<const JointKind> joint_kinds();

}  // namespace cleave::scene_file
