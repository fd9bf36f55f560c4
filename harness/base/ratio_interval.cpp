#include "harness/base/ratio_interval.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "harness/base/median.h"

namespace cleave {

RatioInterval ratio_interval(std::span<const double> a, std::span<const double> b, std::uint64_t seed) {
  assert(a.size() == b.size() && !a.empty());
  std::vector<double> of_a(a.begin(), a.end()), of_b(b.begin(), b.end());
  RatioInterval interval{median_in_place(of_b) / median_in_place(of_a),
                         std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
  if (a.size() < kFewestPairs) return interval;
  std::mt19937_64 engine(seed);
  std::vector<double> ratios;
  for (int k = 0; k < kResamples; ++k) {
    for (std::size_t i = 0; i < a.size(); ++i) {
      const std::size_t drawn = engine() % a.size();
      of_a[i] = a[drawn];
      of_b[i] = b[drawn];
    }
    ratios.push_back(median_in_place(of_b) / median_in_place(of_a));
  }
  if (std::ranges::any_of(ratios, [](double ratio) { return std::isnan(ratio); })) return interval;
  std::ranges::sort(ratios);
  interval.low = ratios[kResamples / 40];
  interval.high = ratios[kResamples - 1 - kResamples / 40];
  return interval;
}

}  // namespace cleave
