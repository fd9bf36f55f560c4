// Surfaces of geoms (harness/base/shapes.h) as flat polygons, in world coordinates: boxes and convex bodies
// as they are, round ones in steps of an angle, their corners on the true surface.
#pragma once

#include <vector>

#include "harness/base/shapes.h"

namespace cleave {

struct PolygonMesh {
  std::vector<double> point;     // (p, 3) m
  std::vector<int> corner;       // points of all polygons, counter-clockwise seen from outside
  std::vector<std::size_t> end;  // (f) where the corners of a polygon end
  std::vector<int> geom;         // (f) whose polygon it is
  std::size_t polygon_count() const { return end.size(); }
};

// Planes are left out: they have no end.
PolygonMesh mesh_of_shapes(const ProblemShapes& shapes);

}  // namespace cleave
