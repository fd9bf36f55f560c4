// The median; of an even number of values the mean of the middle two.
#pragma once

#include <algorithm>
#include <cassert>
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

}  // namespace cleave
