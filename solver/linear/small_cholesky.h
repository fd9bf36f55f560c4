// Inverse of the Cholesky factor of a block of N rows, the diagonal blocks of the factorisations.
#pragma once

#include <cmath>
#include <type_traits>
#include <utility>

namespace cleave {

// call(std::integral_constant 0), ..., call(... N - 1): a loop whose every turn the compiler sees with its
// number.
template <int N, class Call>
inline void unrolled(const Call& call) {
  [&]<int... K>(std::integer_sequence<int, K...>) { (call(std::integral_constant<int, K>()), ...); }
  (std::make_integer_sequence<int, N>());
}

// start - sum_k a_k b_k over `Count` products.
template <int Count>
inline double subtract_products(double start, const double* a, const double* b) {
  unrolled<Count>([&](auto k) { start = std::fma(-a[k], b[k], start); });
  return start;
}

// A = L L^T of an N x N block (column-major, lower triangle read); writes W = L^-1 (upper part zero), which
// may take the place of A. False when a pivot is not positive or not a number; W is then not written.
//
// A chain of N roots and divisions: row j of W is made while the next of them is on its way.
template <int N>
bool invert_cholesky(const double* a, int lda, double* w, int ldw) {
  double l[N][N], inverse[N][N];  // by rows, by columns
  bool is_positive = true;
  unrolled<N>([&](auto j) {
    const double pivot = subtract_products<j>(a[j + lda * j], l[j], l[j]);
    is_positive = is_positive && pivot > 0 && std::isfinite(pivot);
    const double of_pivot = 1 / std::sqrt(pivot);
    unrolled<N - 1 - j>([&](auto below) {
      constexpr int i = j + 1 + below;
      l[i][j] = subtract_products<j>(a[i + lda * j], l[i], l[j]) * of_pivot;
    });
    inverse[j][j] = of_pivot;
    unrolled<j>(
        [&](auto c) { inverse[c][j] = subtract_products<j - c>(0.0, l[j] + c, inverse[c] + c) * of_pivot; });
  });
  if (!is_positive) return false;
  unrolled<N>([&](auto j) {
    double* column = w + ldw * j;
    for (int i = 0; i < j; ++i) column[i] = 0;
    for (int i = j; i < N; ++i) column[i] = inverse[j][i];
  });
  return true;
}

}  // namespace cleave
