// The faces of the convex hull of a few points: of every three the plane is tried, which takes k^4 for k
// points and wants no care with points that lie in one plane.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace cleave {

// Corners of every face, counter-clockwise seen from outside; points within `1e-9` of the points' extent lie
// in a face's plane. Empty where the points lie in one plane.
std::vector<std::vector<int>> convex_hull(const std::vector<Eigen::Vector3d>& points);

}  // namespace cleave
