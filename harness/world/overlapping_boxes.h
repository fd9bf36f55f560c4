// Which of many axis-aligned boxes overlap: what narrows the pairs of geoms down before their shapes are
// looked at.
//
// A binary tree over the boxes, halved at the median of their middles along the longest side of what holds
// them, and walked against itself: O(n log n + pairs) for boxes that overlap few others, whatever their
// sizes. ODE's own spaces sweep along one axis, n^(3/2) on a flat pile and n^(5/3) on a high one, or keep n^2
// bits.
#pragma once

#include <array>
#include <span>
#include <utility>
#include <vector>

namespace cleave {

// Least and greatest coordinate along x, y, z, as ODE orders them; either may be infinite, neither NaN.
using AxisAlignedBox = std::array<double, 6>;

// Every pair of boxes that overlap or touch, once, the lower index first, in no particular order.
std::vector<std::pair<int, int>> overlapping_boxes(std::span<const AxisAlignedBox> boxes);

}  // namespace cleave
