#include "harness/base/nonnegative_least_squares.h"

#include <algorithm>
#include <cmath>

namespace cleave {
namespace {

// Columns that are nearly alike take many rounds; beyond these the answer is as good as any.
constexpr int kMostRounds = 200000;
constexpr double kTolerance = 1e-12;

// H = A^T A and A^T b of columns scaled to length 1.
struct NormalEquations {
  NormalEquations(std::span<const double> a, std::span<const double> b, int unknowns)
      : n(unknowns), length(n, 0.0), h(n * n, 0.0), right(n, 0.0) {
    for (std::size_t k = 0; k < a.size(); ++k) length[k % n] += a[k] * a[k];
    for (double& l : length) l = std::sqrt(l);
    const auto entry = [&](std::size_t row, int i) {
      return length[i] > 0 ? a[row * n + i] / length[i] : 0.0;
    };
    for (std::size_t row = 0; row < b.size(); ++row)
      for (int i = 0; i < n; ++i) {
        right[i] += entry(row, i) * b[row];
        for (int j = 0; j < n; ++j) h[i * n + j] += entry(row, i) * entry(row, j);
      }
  }

  int n;
  std::vector<double> length, h, right;
};

}  // namespace

std::vector<double> nonnegative_least_squares(std::span<const double> a, std::span<const double> b,
                                              int unknowns) {
  const NormalEquations normal(a, b, unknowns);
  std::vector<double> x(unknowns, 0.0), gradient(unknowns);
  std::transform(normal.right.begin(), normal.right.end(), gradient.begin(), std::negate<>());
  const double scale = 1 + *std::max_element(normal.right.begin(), normal.right.end());
  for (int round = 0; round < kMostRounds; ++round) {
    double largest = 0;
    for (int k = 0; k < unknowns; ++k) {
      if (normal.length[k] == 0) continue;
      const double change = std::max(-x[k], -gradient[k]);  // H_kk = 1
      largest = std::max(largest, std::abs(change));
      x[k] += change;
      for (int i = 0; i < unknowns; ++i) gradient[i] += normal.h[i * unknowns + k] * change;
    }
    if (largest <= kTolerance * scale) break;
  }
  for (int k = 0; k < unknowns; ++k)
    if (normal.length[k] > 0) x[k] /= normal.length[k];
  return x;
}

}  // namespace cleave
