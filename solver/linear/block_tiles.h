// Loops of dense_block.h in register tiles, for the instruction set of the file that includes this.
//
// A tile's vectors run down the rows; every element is one sum in ascending order of k, whatever the width of
// the vectors. So all instruction sets give the same bytes.
#pragma once

#include "solver/linear/vector_lanes.h"

namespace cleave {
namespace {

// One register tile: C (Parts * Lanes, 6) -= A B^T.
template <int Lanes, int Parts>
inline void product_tile(int depth, const double* a, int lda, const double* b, int ldb, double* c, int ldc) {
  Vector<Lanes> sum[6][Parts] = {};
  for (int k = 0; k < depth; ++k, a += lda, b += ldb) {
    Vector<Lanes> left[Parts];
    for (int p = 0; p < Parts; ++p) left[p] = load<Lanes>(a + p * Lanes);
#pragma GCC unroll 6
    for (int j = 0; j < 6; ++j) {
      for (int p = 0; p < Parts; ++p) {
        sum[j][p] = multiply_add<Lanes>(left[p], all<Lanes>(b[j]), sum[j][p]);
      }
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

// One register tile of C <- C W^T: column j of the result is sum_{k <= j} C_k W_jk. The product that begins
// the sum is rounded on its own: that of k = 1 (in column 3 of two rows, k = 0), as every stored trajectory
// has it.
template <int Lanes>
inline void transpose_tile(const double* w, int ldw, double* c, int ldc) {
  Vector<Lanes> in[6];
  for (int k = 0; k < 6; ++k) in[k] = load<Lanes>(c + k * ldc);
  store<Lanes>(c, in[0] * all<Lanes>(w[0]));
#pragma GCC unroll 6
  for (int j = 1; j < 6; ++j) {
    const int first = Lanes == 2 && j == 3 ? 0 : 1, second = 1 - first;
    Vector<Lanes> sum = in[first] * all<Lanes>(w[j + ldw * first]);
    sum = multiply_add<Lanes>(in[second], all<Lanes>(w[j + ldw * second]), sum);
    for (int k = 2; k <= j; ++k) sum = multiply_add<Lanes>(in[k], all<Lanes>(w[j + ldw * k]), sum);
    store<Lanes>(c + j * ldc, sum);
  }
}

// Columns first..first+3 of the 12x12 Gram matrix from row block `top` on, four columns at a time so that the
// sums stay in registers.
template <int Parts>
inline void gram_columns(int rows, const double* jacobian, const double* d, int first, double* h) {
  constexpr int top = 12 - 4 * Parts;
  Vector<4> sum[4][Parts] = {};
  for (int r = 0; r < rows; ++r) {
    if (d[r] == 0) continue;
    const double* j = jacobian + 12 * r;
    Vector<4> left[Parts];
    for (int p = 0; p < Parts; ++p) left[p] = load<4>(j + top + 4 * p) * all<4>(d[r]);
    for (int c = 0; c < 4; ++c) {
      for (int p = 0; p < Parts; ++p) {
        sum[c][p] = multiply_add<4>(left[p], all<4>(j[first + c]), sum[c][p]);
      }
    }
  }
  for (int c = 0; c < 4; ++c) {
    for (int p = 0; p < Parts; ++p) store<4>(h + 12 * (first + c) + top + 4 * p, sum[c][p]);
  }
}

void subtract_product_tiled(int rows, int depth, const double* a, int lda, const double* b, int ldb,
                            double* c, int ldc) {
  int row = 0;
#ifdef __AVX512F__
  for (; row + 16 <= rows; row += 16) product_tile<8, 2>(depth, a + row, lda, b, ldb, c + row, ldc);
  if (row + 8 <= rows) {
    product_tile<8, 1>(depth, a + row, lda, b, ldb, c + row, ldc);
    row += 8;
  }
#else
  for (; row + 8 <= rows; row += 8) product_tile<4, 2>(depth, a + row, lda, b, ldb, c + row, ldc);
#endif
  if (row + 4 <= rows) {
    product_tile<4, 1>(depth, a + row, lda, b, ldb, c + row, ldc);
    row += 4;
  }
  if (row < rows) product_tile<2, 1>(depth, a + row, lda, b, ldb, c + row, ldc);
}

void multiply_by_transpose_tiled(int rows, const double* w, int ldw, double* c, int ldc) {
  int row = 0;
  for (; row + kWidestLanes <= rows; row += kWidestLanes) transpose_tile<kWidestLanes>(w, ldw, c + row, ldc);
  for (; row + 4 <= rows; row += 4) transpose_tile<4>(w, ldw, c + row, ldc);
  if (row < rows) transpose_tile<2>(w, ldw, c + row, ldc);
}

bool weighted_gram_tiled(int rows, const double* jacobian, const double* d, double* h) {
  bool any = false;
  for (int r = 0; r < rows; ++r) any |= d[r] != 0;
  if (!any) return false;
  gram_columns<3>(rows, jacobian, d, 0, h);
  gram_columns<3>(rows, jacobian, d, 4, h);  // from row 0: the first body's block spans columns 0..5
  gram_columns<2>(rows, jacobian, d, 8, h);
  return true;
}

}  // namespace
}  // namespace cleave
