// Inverse of the Cholesky factor of a block of N rows, the diagonal blocks of the factorisations.
//
// Every stored trajectory depends on how the sums below are rounded: products of a group (four in a pivot,
// two elsewhere) are rounded apart, what is left is fused. The order is that of the first release and has no
// other merit.
#pragma once

#include <cmath>

namespace cleave {

// start - sum_k a_k b_k over `count` products, those of every whole group of `Group` rounded apart.
template <int Group>
inline double subtract_products(double start, const double* a, const double* b, int count) {
  int k = 0;
  for (; k < count / Group * Group; ++k) start -= a[k] * b[k];
  for (; k < count; ++k) start = std::fma(-a[k], b[k], start);
  return start;
}

// A = L L^T of an N x N block (column-major, lower triangle read); writes W = L^-1 (upper part zero), which
// may take the place of A. False when a pivot is not positive or not a number; W is then not written.
template <int N>
bool invert_cholesky(const double* a, int lda, double* w, int ldw) {
  double l[N][N], inverse[N];
  for (int j = 0; j < N; ++j) {
    const double pivot = subtract_products<4>(a[j + lda * j], l[j], l[j], j);
    if (!(pivot > 0) || !std::isfinite(pivot)) return false;
    inverse[j] = 1 / std::sqrt(pivot);
    for (int i = j + 1; i < N; ++i)
      l[i][j] = subtract_products<2>(a[i + lda * j], l[i], l[j], j) * inverse[j];
  }
  for (int j = 0; j < N; ++j) {
    double* column = w + ldw * j;
    for (int i = 0; i < j; ++i) column[i] = 0;
    column[j] = inverse[j];
    for (int i = j + 1; i < N; ++i) {
      column[i] = subtract_products<2>(0.0, l[i] + j, column + j, i - j) * inverse[i];
    }
  }
  return true;
}

}  // namespace cleave
