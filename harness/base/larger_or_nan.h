// The worst of numbers, one after another: a NaN must not pass unseen, and stays whatever comes after it.
#pragma once

#include <cmath>
#include <limits>

namespace cleave {

inline double larger_or_nan(double a, double b) { return a > b || std::isnan(a) ? a : b; }

// a: no NaN. Infinite where b is one.
inline double larger_or_infinite(double a, double b) {
  if (b <= a) return a;
  return b > a ? b : std::numeric_limits<double>::infinity();
}

}  // namespace cleave
