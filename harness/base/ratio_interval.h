// How sure a ratio of medians is: a bootstrap over pairs (Efron and Tibshirani, An Introduction to the
// Bootstrap, 1993, chapter 13).
#pragma once

#include <cstdint>
#include <span>

namespace cleave {

struct RatioInterval {
  double ratio = 0;  // median of b over median of a
  double low = 0,
         high =
             0;  // 95 % of the resamples lie within; NaN for fewer than kFewestPairs, or where one is 0 / 0
};

inline constexpr int kFewestPairs = 5;
inline constexpr int kResamples = 2000;

// a, b: the same measurement in two settings, pair by pair; at least one pair. Pairs are drawn together, so
// that what both have in common drops out. The seed makes the draws.
RatioInterval ratio_interval(std::span<const double> a, std::span<const double> b, std::uint64_t seed);

}  // namespace cleave
