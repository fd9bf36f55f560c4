// Loops of dense_panel.h in register tiles, for the instruction set of the file that includes this.
//
// Where AVX-512 holds a tile of 24 x 8 in registers, AVX2 does it in four of 12 x 4. Every element is one sum
// in ascending order of k in both, and the dot products of the backward solve add the same eight partial sums
// in the same order: the bytes are equal.
#pragma once

#include "solver/linear/panel_layout.h"
#include "solver/linear/vector_lanes.h"

namespace cleave {
namespace {

constexpr int kTileColumns = kWidestLanes == 8 ? 8 : 4;  // accumulators: 3 vectors a column
constexpr int kTileRows = 3 * kWidestLanes;

// C (kTileRows, kTileColumns) -= A B^T, all within row panels.
inline void panel_tile(int depth, const double* a, const double* b, double* c) {
  constexpr int L = kWidestLanes;
  Vector<L> sum[kTileColumns][3] = {};
  for (int k = 0; k < depth; ++k, a += kPanelRows, b += kPanelRows) {
    const Vector<L> left[3] = {load<L>(a), load<L>(a + L), load<L>(a + 2 * L)};
#pragma GCC unroll 8
    for (int j = 0; j < kTileColumns; ++j) {
      const Vector<L> right = all<L>(b[j]);
      for (int p = 0; p < 3; ++p) sum[j][p] = multiply_add<L>(left[p], right, sum[j][p]);
    }
  }
#pragma GCC unroll 8
  for (int j = 0; j < kTileColumns; ++j) {
    for (int p = 0; p < 3; ++p) {
      double* target = c + kPanelRows * j + p * L;
      store<L>(target, load<L>(target) - sum[j][p]);
    }
  }
}

void subtract_panel_product_tiled(int depth, const double* a, const double* b, double* c) {
  for (int row = 0; row < kPanelRows; row += kTileRows) {
    for (int column = 0; column < kPanelColumns; column += kTileColumns) {
      panel_tile(depth, a + row, b + column, c + kPanelRows * column + row);
    }
  }
}

void multiply_panel_by_transpose_tiled(const double* w, int first_row, double* c) {
  constexpr int L = kWidestLanes;
  for (int row = first_row; row < kPanelRows; row += L) {
    Vector<L> in[kPanelColumns];
    for (int k = 0; k < kPanelColumns; ++k) in[k] = load<L>(c + kPanelRows * k + row);
#pragma GCC unroll 8
    for (int j = 0; j < kPanelColumns; ++j) {
      Vector<L> sum = in[0] * all<L>(w[j]);
      for (int k = 1; k <= j; ++k) sum = multiply_add<L>(in[k], all<L>(w[j + kPanelRows * k]), sum);
      store<L>(c + kPanelRows * j + row, sum);
    }
  }
}

void subtract_panel_vector_tiled(int columns, const double* panel, const double* x, double* y) {
  constexpr int L = kWidestLanes, Parts = kPanelRows / L;
  Vector<L> sum[Parts] = {};
  for (int c = 0; c < columns; ++c, panel += kPanelRows) {
    const Vector<L> right = all<L>(x[c]);
    for (int p = 0; p < Parts; ++p) sum[p] = multiply_add<L>(load<L>(panel + p * L), right, sum[p]);
  }
  for (int p = 0; p < Parts; ++p) store<L>(y + p * L, load<L>(y + p * L) - sum[p]);
}

void subtract_panel_transpose_tiled(int columns, const double* panel, const double* y, double* x) {
  constexpr int L = kWidestLanes, Halves = 8 / L;
  Vector<L> right[3][Halves];
  for (int p = 0; p < 3; ++p) {
    for (int h = 0; h < Halves; ++h) right[p][h] = load<L>(y + 8 * p + L * h);
  }
  for (int c = 0; c < columns; ++c, panel += kPanelRows) {
    double part[8];
    for (int h = 0; h < Halves; ++h) {
      Vector<L> sum = load<L>(panel + L * h) * right[0][h];
      sum = multiply_add<L>(load<L>(panel + 8 + L * h), right[1][h], sum);
      sum = multiply_add<L>(load<L>(panel + 16 + L * h), right[2][h], sum);
      store<L>(part + L * h, sum);
    }
    const Vector<4> four = load<4>(part) + load<4>(part + 4);
    x[c] -= (four[0] + four[2]) + (four[1] + four[3]);
  }
}

}  // namespace
}  // namespace cleave
