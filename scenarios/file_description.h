// What a scene file says, in plain data: made by file_reader, put into a world by file_scene.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/file_kinds.h"
#include "scenarios/file_number.h"

namespace cleave::scene_file {

using Vector = std::array<double, 3>;

// Everything with normal . x < offset_m is solid; the normal is of unit length.
struct Plane {
  Vector normal{0, 0, 1};
  double offset_m = 0;
};

// Cell (i, j, k) of a grid lies off the body's position by spacing times i - (count - 1) / 2 along x and y,
// the middle of which is the position, and times k along z, where the position is the lowest cell. i runs
// fastest.
struct Grid {
  std::array<int, 3> count{1, 1, 1};
  Vector spacing_m{};
};

// How bodies of one row of points hold on to each other.
struct Link {
  const JointKind* kind;
  Vector axis{};
};

// Bodies of one kind: one, or a grid of them, or a row of them from point to point.
struct Bodies {
  std::string group;  // empty: of none
  const ShapeKind* shape = nullptr;
  Size size;
  Number mass_kg;
  DrawnVector position_m{};
  std::array<double, 4> orientation{1, 0, 0, 0};  // quaternion w x y z
  bool random_orientation = false;
  DrawnVector velocity_m_per_s{}, angular_velocity_rad_per_s{};
  bool gravity = true;
  Grid grid;
  std::vector<Vector>
      through_m;  // not empty: body i reaches from point i to point i + 1 along its own z axis
  std::optional<Link> joined_by;  // of such bodies, at the points between them

  int count() const {
    if (!through_m.empty()) return static_cast<int>(through_m.size()) - 1;
    return grid.count[0] * grid.count[1] * grid.count[2];
  }
};

struct Joint {
  const JointKind* kind = nullptr;
  int body_a = 0, body_b = -1;  // in creation order; -1: the static world
  Vector anchor_m{}, axis{};
};

// What happens to some bodies before a step is collided.
struct Event {
  int step = 0;
  std::vector<int> bodies;
  std::optional<bool> gravity;
  std::optional<DrawnVector> velocity_m_per_s, angular_velocity_rad_per_s;
};

struct Description {
  std::string content_id;       // fingerprint of the file's bytes
  double contact_layer_m = 0;   // overlap that is not pushed out
  std::vector<Plane> planes;    // the pit's walls not among them
  double pit_half_width_m = 0;  // 0: no pit
  std::vector<Bodies> bodies;
  std::vector<Joint> joints;
  std::vector<Event> events;
};

}  // namespace cleave::scene_file
