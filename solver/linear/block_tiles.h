// Loops of dense_block.h in register tiles, for the instruction set of the file that includes this.
//
// A tile's vectors run down the rows; every element is one sum in ascending order of k, whatever the width of
// the vectors. So all instruction sets give the same bytes.
#pragma once

#include "solver/linear/vector_lanes.h"

namespace cleave {
namespace {

enum class Begin { at_what_is_there, at_zero };

// One register tile: C (Parts * Lanes, 6) -= A B^T, from what is there or from zero; last: how the last of
// its Parts is read and written.
template <int Lanes, int Parts, Begin kBegin, class Last = WholeVector<Lanes>>
inline void product_tile(int depth, const double* a, int lda, const double* b, int ldb, double* c, int ldc,
                         const Last& last = {}) {
  constexpr WholeVector<Lanes> whole;
  Vector<Lanes> sum[6][Parts] = {};
  for (int k = 0; k < depth; ++k, a += lda, b += ldb) {
    Vector<Lanes> left[Parts];
    for (int p = 0; p < Parts - 1; ++p) left[p] = whole.read(a + p * Lanes);
    left[Parts - 1] = last.read(a + (Parts - 1) * Lanes);
#pragma GCC unroll 6
    for (int j = 0; j < 6; ++j) {
      for (int p = 0; p < Parts; ++p) {
        sum[j][p] = multiply_add<Lanes>(left[p], all<Lanes>(b[j]), sum[j][p]);
      }
    }
  }
  const auto subtract = [&](const auto& part, double* target, Vector<Lanes> product) {
    part.write(target, (kBegin == Begin::at_zero ? Vector<Lanes>{} : part.read(target)) - product);
  };
#pragma GCC unroll 6
  for (int j = 0; j < 6; ++j) {
    double* target = c + j * ldc;
    for (int p = 0; p < Parts - 1; ++p) subtract(whole, target + p * Lanes, sum[j][p]);
    subtract(last, target + (Parts - 1) * Lanes, sum[j][Parts - 1]);
  }
}

// One register tile of C <- C W^T: column j of the result is sum_{k <= j} C_k W_jk.
template <int Lanes, class Part = WholeVector<Lanes>>
inline void transpose_tile(const double* w, int ldw, double* c, int ldc, const Part& part = {}) {
  Vector<Lanes> in[6];
  for (int k = 0; k < 6; ++k) in[k] = part.read(c + k * ldc);
#pragma GCC unroll 6
  for (int j = 0; j < 6; ++j) {
    Vector<Lanes> sum = in[0] * all<Lanes>(w[j]);
    for (int k = 1; k <= j; ++k) sum = multiply_add<Lanes>(in[k], all<Lanes>(w[j + ldw * k]), sum);
    part.write(c + j * ldc, sum);
  }
}

// Columns first .. first + Columns - 1 of the 12x12 Gram matrix, rows top .. top + Parts * Lanes - 1: so many
// that the sums stay in registers.
template <int Lanes, int Parts, int Columns>
inline void gram_columns(int rows, const double* jacobian, const double* d, int first, int top, double* h) {
  Vector<Lanes> sum[Columns][Parts] = {};
  for (int r = 0; r < rows; ++r) {
    if (d[r] == 0) continue;
    const double* j = jacobian + 12 * r;
    Vector<Lanes> left[Parts];
    for (int p = 0; p < Parts; ++p) left[p] = load<Lanes>(j + top + Lanes * p) * all<Lanes>(d[r]);
#pragma GCC unroll 6
    for (int c = 0; c < Columns; ++c) {
      for (int p = 0; p < Parts; ++p) {
        sum[c][p] = multiply_add<Lanes>(left[p], all<Lanes>(j[first + c]), sum[c][p]);
      }
    }
  }
#pragma GCC unroll 6
  for (int c = 0; c < Columns; ++c) {
    for (int p = 0; p < Parts; ++p) store<Lanes>(h + 12 * (first + c) + top + Lanes * p, sum[c][p]);
  }
}

template <Begin kBegin>
void subtract_product_tiled(int rows, int depth, const double* a, int lda, const double* b, int ldb,
                            double* c, int ldc) {
  constexpr int kWhole = 2 * kWidestLanes;
  int row = 0;
  for (; row + kWhole <= rows; row += kWhole)
    product_tile<kWidestLanes, 2, kBegin>(depth, a + row, lda, b, ldb, c + row, ldc);
#ifdef __AVX512F__
  const int left = rows - row;
  if (left > 8)
    product_tile<8, 2, kBegin>(depth, a + row, lda, b, ldb, c + row, ldc, FirstLanes(left - 8));
  else if (left > 0)
    product_tile<8, 1, kBegin>(depth, a + row, lda, b, ldb, c + row, ldc, FirstLanes(left));
#else
  if (row + 4 <= rows) {
    product_tile<4, 1, kBegin>(depth, a + row, lda, b, ldb, c + row, ldc);
    row += 4;
  }
  if (row < rows) product_tile<2, 1, kBegin>(depth, a + row, lda, b, ldb, c + row, ldc);
#endif
}

void multiply_by_transpose_tiled(int rows, const double* w, int ldw, double* c, int ldc) {
  int row = 0;
  for (; row + kWidestLanes <= rows; row += kWidestLanes) transpose_tile<kWidestLanes>(w, ldw, c + row, ldc);
#ifdef __AVX512F__
  if (row < rows) transpose_tile<8>(w, ldw, c + row, ldc, FirstLanes(rows - row));
#else
  if (row < rows) transpose_tile<2>(w, ldw, c + row, ldc);
#endif
}

// A body's blocks span six rows and columns, which are no whole number of vectors: some go further.
bool weighted_gram_tiled(int bodies, int rows, const double* jacobian, const double* d, double* h) {
  bool any = false;
  for (int r = 0; r < rows; ++r) any |= d[r] != 0;
  if (!any) return false;
#ifdef __AVX512F__
  gram_columns<8, 1, 6>(rows, jacobian, d, 0, 0, h);
  if (bodies == 1) return true;
  gram_columns<4, 1, 6>(rows, jacobian, d, 0, 8, h);
  gram_columns<8, 1, 6>(rows, jacobian, d, 6, 4, h);
#else
  if (bodies == 1) {
    gram_columns<4, 2, 6>(rows, jacobian, d, 0, 0, h);
    return true;
  }
  gram_columns<4, 3, 4>(rows, jacobian, d, 0, 0, h);
  gram_columns<4, 3, 4>(rows, jacobian, d, 4, 0, h);
  gram_columns<4, 2, 4>(rows, jacobian, d, 8, 4, h);
#endif
  return true;
}

}  // namespace
}  // namespace cleave
