// What bodies and static geometry look like, as plain data: for problem files, recordings and pictures.
#pragma once

#include <cstdint>
#include <vector>

namespace cleave {

enum class GeomType : std::uint8_t { box = 0, sphere, capsule, cylinder, convex, plane };

// What bodies and static geometry look like: g geoms with world poses at the start of the step.
//
//     type       size                            own frame
//     box        edge lengths x, y, z            centre
//     sphere     radius                          centre
//     capsule    radius, length without caps     centre, along z
//     cylinder   radius, length                  centre, along z
//     convex     -                               frame of its convex_points
//     plane      -                               the point nearest the world's origin, z the outward normal
//
// Unused sizes are zero.
struct ProblemShapes {
  std::vector<int> geom_body;            // (g) -1 = static
  std::vector<std::uint8_t> geom_type;   // (g) a GeomType
  std::vector<double> geom_size;         // (g, 3) m
  std::vector<double> geom_position;     // (g, 3) m
  std::vector<double> geom_orientation;  // (g, 4) quaternion w x y z
  std::vector<double> convex_points;     // (k, 3) corners of all convex geoms, m, in their own frames
  std::vector<int> convex_first = {0};   // (g + 1) corners of geom i are convex_first[i] .. convex_first[i+1]

  bool operator==(const ProblemShapes&) const = default;
};

}  // namespace cleave
