// The worst of numbers, one after another: a NaN must not pass unseen, and stays whatever comes after it.
#pragma once

#include <cmath>

namespace cleave {

inline double larger_or_nan(double a, double b) { return a > b || std::isnan(a) ? a : b; }

}  // namespace cleave
