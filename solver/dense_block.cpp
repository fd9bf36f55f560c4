#include "solver/dense_block.h"

#include <cmath>
#include <cstring>

namespace cleave {
namespace {

// A vector of `Bytes / 8` doubles that may lie at any address.
template <int Lanes>
struct Vec {
  typedef double Type __attribute__((vector_size(Lanes * 8)));
};

template <int Lanes>
inline typename Vec<Lanes>::Type load(const double* p) {
  typename Vec<Lanes>::Type v;
  std::memcpy(&v, p, sizeof v);
  return v;
}

template <int Lanes>
inline void store(double* p, typename Vec<Lanes>::Type v) {
  std::memcpy(p, &v, sizeof v);
}

// One register tile: C (Parts * Lanes, 6) -= A B^T.
template <int Lanes, int Parts>
inline void product_tile(int depth, const double* a, int lda, const double* b, int ldb, double* c, int ldc) {
  typename Vec<Lanes>::Type sum[6][Parts] = {};
  for (int k = 0; k < depth; ++k, a += lda, b += ldb) {
    typename Vec<Lanes>::Type left[Parts];
    for (int p = 0; p < Parts; ++p) left[p] = load<Lanes>(a + p * Lanes);
#pragma GCC unroll 6
    for (int j = 0; j < 6; ++j) {
      for (int p = 0; p < Parts; ++p) sum[j][p] += left[p] * b[j];
    }
  }
#pragma GCC unroll 6
  for (int j = 0; j < 6; ++j) {
    for (int p = 0; p < Parts; ++p) {
      double* target = c + j * ldc + p * Lanes;
      store<Lanes>(target, load<Lanes>(target) - sum[j][p]);
    }
  }
}

// One register tile of C <- C W^T: column j of the result is sum_{k <= j} C_k W_jk.
template <int Lanes>
inline void transpose_tile(const double* w, int ldw, double* c, int ldc) {
  typename Vec<Lanes>::Type in[6];
  for (int k = 0; k < 6; ++k) in[k] = load<Lanes>(c + k * ldc);
#pragma GCC unroll 6
  for (int j = 0; j < 6; ++j) {
    typename Vec<Lanes>::Type sum = in[0] * w[j];
    for (int k = 1; k <= j; ++k) sum += in[k] * w[j + ldw * k];
    store<Lanes>(c + j * ldc, sum);
  }
}

// Columns first..first+3 of the 12x12 Gram matrix from row block `top` on, four columns at a time so that the
// sums stay in registers.
template <int Parts>
inline void gram_columns(int rows, const double* jacobian, const double* d, int first, double* h) {
  constexpr int top = 12 - 4 * Parts;
  typename Vec<4>::Type sum[4][Parts] = {};
  for (int r = 0; r < rows; ++r) {
    if (d[r] == 0) continue;
    const double* j = jacobian + 12 * r;
    typename Vec<4>::Type left[Parts];
    for (int p = 0; p < Parts; ++p) left[p] = load<4>(j + top + 4 * p) * d[r];
    for (int c = 0; c < 4; ++c) {
      for (int p = 0; p < Parts; ++p) sum[c][p] += left[p] * j[first + c];
    }
  }
  for (int c = 0; c < 4; ++c) {
    for (int p = 0; p < Parts; ++p) store<4>(h + 12 * (first + c) + top + 4 * p, sum[c][p]);
  }
}

}  // namespace

void subtract_product(int rows, int depth, const double* a, int lda, const double* b, int ldb, double* c,
                      int ldc) {
  int row = 0;
  for (; row + 8 <= rows; row += 8) product_tile<4, 2>(depth, a + row, lda, b, ldb, c + row, ldc);
  if (row + 4 <= rows) {
    product_tile<4, 1>(depth, a + row, lda, b, ldb, c + row, ldc);
    row += 4;
  }
  if (row < rows) product_tile<2, 1>(depth, a + row, lda, b, ldb, c + row, ldc);
}

void multiply_by_transpose(int rows, const double* w, int ldw, double* c, int ldc) {
  int row = 0;
  for (; row + 4 <= rows; row += 4) transpose_tile<4>(w, ldw, c + row, ldc);
  if (row < rows) transpose_tile<2>(w, ldw, c + row, ldc);
}

bool invert_cholesky(const double* a, int lda, double* w) {
  double l[6][6];
  double inverse[6];
  for (int j = 0; j < 6; ++j) {
    double pivot = a[j + j * lda];
    for (int k = 0; k < j; ++k) pivot -= l[j][k] * l[j][k];
    if (!(pivot > 0) || !std::isfinite(pivot)) return false;
    inverse[j] = 1 / std::sqrt(pivot);
    for (int i = j + 1; i < 6; ++i) {
      double sum = a[i + j * lda];
      for (int k = 0; k < j; ++k) sum -= l[i][k] * l[j][k];
      l[i][j] = sum * inverse[j];
    }
  }
  for (int j = 0; j < 6; ++j) {
    for (int i = 0; i < j; ++i) w[i + 6 * j] = 0;
    w[j + 6 * j] = inverse[j];
    for (int i = j + 1; i < 6; ++i) {
      double sum = 0;
      for (int k = j; k < i; ++k) sum += l[i][k] * w[k + 6 * j];
      w[i + 6 * j] = -sum * inverse[i];
    }
  }
  return true;
}

bool weighted_gram(int rows, const double* jacobian, const double* d, double* h) {
  bool any = false;
  for (int r = 0; r < rows; ++r) any |= d[r] != 0;
  if (!any) return false;
  gram_columns<3>(rows, jacobian, d, 0, h);
  gram_columns<3>(rows, jacobian, d, 4, h);  // from row 0: the first body's block spans columns 0..5
  gram_columns<2>(rows, jacobian, d, 8, h);
  return true;
}

void subtract_matrix_vector(int rows, int columns, const double* a, int lda, const double* x, double* y) {
  for (int c = 0; c < columns; c += 2, a += 2 * lda) {
    const double x0 = x[c], x1 = x[c + 1];
    for (int r = 0; r < rows; ++r) y[r] -= a[r] * x0 + a[r + lda] * x1;
  }
}

void subtract_transpose_vector(int rows, int columns, const double* a, int lda, const double* y, double* x) {
  for (int c = 0; c < columns; c += 2, a += 2 * lda) {
    typename Vec<4>::Type sum0 = {}, sum1 = {};
    int r = 0;
    for (; r + 4 <= rows; r += 4) {
      const auto left = load<4>(y + r);
      sum0 += load<4>(a + r) * left;
      sum1 += load<4>(a + r + lda) * left;
    }
    double tail0 = 0, tail1 = 0;
    for (; r < rows; ++r) tail0 += a[r] * y[r], tail1 += a[r + lda] * y[r];
    x[c] -= (sum0[0] + sum0[1]) + (sum0[2] + sum0[3]) + tail0;
    x[c + 1] -= (sum1[0] + sum1[1]) + (sum1[2] + sum1[3]) + tail1;
  }
}

}  // namespace cleave
