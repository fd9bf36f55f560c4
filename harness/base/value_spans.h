// Questions about spans of numbers. The judge (solver/residual.h) asks its own: it shares nothing with who it
// judges.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "harness/base/larger_or_nan.h"

namespace cleave {

inline bool all_finite(std::span<const double> values) {
  return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
}

// Largest |a_i - b_i|; NaN when one is no number or the sizes differ.
inline double largest_difference(std::span<const double> a, std::span<const double> b) {
  if (a.size() != b.size()) return std::numeric_limits<double>::quiet_NaN();
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = larger_or_nan(largest, std::abs(a[i] - b[i]));
  return largest;
}

}  // namespace cleave
