#include "harness/files/convex_hull.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace cleave {
namespace {

using Eigen::Vector3d;
using Face = std::vector<int>;

double extent_of(const std::vector<Vector3d>& points) {
  double extent = 0;
  for (const Vector3d& point : points) extent = std::max(extent, (point - points.front()).norm());
  return extent;
}

// All points in the plane through `origin` with this unit normal, where no point lies beyond it; else none.
Face points_of_plane(const std::vector<Vector3d>& points, const Vector3d& origin, const Vector3d& normal,
                     double tolerance) {
  Face face;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double height = normal.dot(points[k] - origin);
    if (height > tolerance) return {};
    if (height > -tolerance) face.push_back(static_cast<int>(k));
  }
  return face.size() == points.size() ? Face{} : face;
}

// By the angle about their middle; those that are no corners, on an edge or inside, are left out.
void sort_around(const std::vector<Vector3d>& points, const Vector3d& normal, double tolerance, Face& face) {
  Vector3d middle = Vector3d::Zero();
  for (const int k : face) middle += points[k] / static_cast<double>(face.size());
  const Vector3d x = normal.unitOrthogonal(), y = normal.cross(x);
  std::ranges::sort(face, {}, [&](int k) {
    const Vector3d arm = points[k] - middle;
    return std::atan2(arm.dot(y), arm.dot(x));
  });
  const auto is_no_corner = [&](std::size_t place) {
    const Vector3d& before = points[face[(place + face.size() - 1) % face.size()]];
    const Vector3d& after = points[face[(place + 1) % face.size()]];
    const Vector3d edge = after - before;
    return normal.dot((points[face[place]] - before).cross(edge)) <= tolerance * edge.norm();
  };
  for (std::size_t place = 0; face.size() > 3 && place < face.size();) {
    if (is_no_corner(place)) {
      face.erase(face.begin() + static_cast<std::ptrdiff_t>(place));
      place = 0;
    } else {
      ++place;
    }
  }
}

}  // namespace

std::vector<std::vector<int>> convex_hull(const std::vector<Vector3d>& points) {
  const int count = static_cast<int>(points.size());
  std::vector<Face> faces;
  if (count < 4) return faces;
  const double tolerance = 1e-9 * extent_of(points);
  std::vector<Face> known;  // as found, sorted by number
  for (int a = 0; a < count; ++a)
    for (int b = a + 1; b < count; ++b)
      for (int c = b + 1; c < count; ++c) {
        const Vector3d across = (points[b] - points[a]).cross(points[c] - points[a]);
        if (across.norm() <= tolerance * tolerance) continue;
        for (const Vector3d& normal : {Vector3d(across.normalized()), Vector3d(-across.normalized())}) {
          Face face = points_of_plane(points, points[a], normal, tolerance);
          if (face.empty() || std::ranges::count(known, face) > 0) continue;
          known.push_back(face);
          sort_around(points, normal, tolerance, face);
          faces.push_back(std::move(face));
        }
      }
  return faces;
}

}  // namespace cleave
