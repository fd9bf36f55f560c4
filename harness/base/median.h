// Medians: of an even number of values the mean of the middle two, or the lower of them where it is to be one
// that occurs.
#pragma once

#include <algorithm>
#include <cassert>
#include <limits>
#include <span>
#include <vector>

namespace cleave {

// values: at least one, none NaN; they are reordered.
inline double median_in_place(std::span<double> values) {
  assert(!values.empty());
  const auto middle = values.begin() + values.size() / 2;
  std::ranges::nth_element(values, middle);
  if (values.size() % 2 == 1) return *middle;
  return (*std::max_element(values.begin(), middle) + *middle) / 2;
}

inline double median(std::vector<double> values) { return median_in_place(values); }

// NaN of no values.
inline double lower_median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = values.begin() + (values.size() - 1) / 2;
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace cleave
