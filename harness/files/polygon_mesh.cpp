#include "harness/files/polygon_mesh.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <utility>

#include "harness/files/convex_hull.h"

namespace cleave {
namespace {

using Eigen::Vector3d;
using Polygon = std::vector<int>;
constexpr int kSegments = 24;  // around an axis

struct Surface {
  std::vector<Vector3d> points;
  std::vector<Polygon> polygons;
};

Surface convex_surface(std::vector<Vector3d> corners) {
  Surface surface{std::move(corners), {}};
  surface.polygons = convex_hull(surface.points);
  return surface;
}

Surface box_surface(const Vector3d& size) {
  std::vector<Vector3d> corners;
  for (int k = 0; k < 8; ++k)
    corners.emplace_back((k & 1 ? 0.5 : -0.5) * size.x(), (k & 2 ? 0.5 : -0.5) * size.y(),
                         (k & 4 ? 0.5 : -0.5) * size.z());
  return convex_surface(std::move(corners));
}

// A profile of (radius, z), from below to above, turned about z. Its ends lie on the axis.
Surface turned_surface(const std::vector<std::pair<double, double>>& profile) {
  Surface surface;
  const int rings = static_cast<int>(profile.size());
  const auto point = [](int ring, int segment) { return kSegments * ring + segment % kSegments; };
  for (const auto& [radius, z] : profile)
    for (int s = 0; s < kSegments; ++s) {
      const double angle = 2 * std::numbers::pi * s / kSegments;
      surface.points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
  for (int ring = 0; ring + 1 < rings; ++ring)
    for (int s = 0; s < kSegments; ++s) {
      Polygon polygon = {point(ring, s), point(ring, s + 1)};
      if (ring == 0) polygon = {point(ring, 0), point(ring + 1, s + 1), point(ring + 1, s)};
      if (ring > 0) polygon.push_back(point(ring + 1, ring + 2 == rings ? 0 : s + 1));
      if (ring > 0 && ring + 2 < rings) polygon.push_back(point(ring + 1, s));
      surface.polygons.push_back(std::move(polygon));
    }
  return surface;
}

// A ball cut in two at its equator, whose halves are `length` apart.
Surface capsule_surface(double radius, double length) {
  constexpr int kHalf = kSegments / 4;
  std::vector<std::pair<double, double>> profile;
  for (const double side : {-1.0, 1.0})
    for (int k = 0; k <= kHalf; ++k) {
      const double latitude = std::numbers::pi / 2 * (side < 0 ? k - kHalf : k) / kHalf;
      const bool is_pole = k == (side < 0 ? 0 : kHalf);
      const bool is_double = side > 0 && k == 0 && length == 0;
      if (!is_double)
        profile.emplace_back(is_pole ? 0 : radius * std::cos(latitude),
                             radius * std::sin(latitude) + side * length / 2);
    }
  return turned_surface(profile);
}

Surface cylinder_surface(double radius, double length) {
  return turned_surface({{0, -length / 2}, {radius, -length / 2}, {radius, length / 2}, {0, length / 2}});
}

Surface surface_of(const ProblemShapes& shapes, std::size_t geom) {
  const double* size = shapes.geom_size.data() + 3 * geom;
  switch (static_cast<GeomType>(shapes.geom_type[geom])) {
    case GeomType::box:
      return box_surface({size[0], size[1], size[2]});
    case GeomType::sphere:
      return capsule_surface(size[0], 0);
    case GeomType::capsule:
      return capsule_surface(size[0], size[1]);
    case GeomType::cylinder:
      return cylinder_surface(size[0], size[1]);
    case GeomType::convex: {
      std::vector<Vector3d> corners;
      for (int k = shapes.convex_first[geom]; k < shapes.convex_first[geom + 1]; ++k)
        corners.push_back(Vector3d::Map(shapes.convex_points.data() + 3 * std::size_t(k)));
      return convex_surface(std::move(corners));
    }
    case GeomType::plane:
      return {};
  }
  return {};
}

}  // namespace

PolygonMesh mesh_of_shapes(const ProblemShapes& shapes) {
  PolygonMesh mesh;
  for (std::size_t geom = 0; geom < shapes.geom_body.size(); ++geom) {
    const Surface surface = surface_of(shapes, geom);
    const double* turn = shapes.geom_orientation.data() + 4 * geom;
    const Eigen::Quaterniond orientation(turn[0], turn[1], turn[2], turn[3]);
    const Vector3d place = Vector3d::Map(shapes.geom_position.data() + 3 * geom);
    const int first = static_cast<int>(mesh.point.size() / 3);
    for (const Vector3d& point : surface.points) {
      const Vector3d there = place + orientation * point;
      mesh.point.insert(mesh.point.end(), there.begin(), there.end());
    }
    for (const Polygon& polygon : surface.polygons) {
      for (const int corner : polygon) mesh.corner.push_back(first + corner);
      mesh.end.push_back(mesh.corner.size());
      mesh.geom.push_back(static_cast<int>(geom));
    }
  }
  return mesh;
}

}  // namespace cleave
