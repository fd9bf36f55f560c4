// Dense kernels on row panels: the inner loops of the dense Cholesky factorisation (dense_cholesky.h).
//
// A row panel holds kPanelRows rows of a matrix, column after column: entry (r, c) is at r + kPanelRows c. In
// this layout the operands of a product are read in the order in which they lie, without being copied. Groups
// of kPanelColumns rows of a panel (entries 8 q .. 8 q + 7 of each column) are the right operands.
#pragma once

#include "solver/linear/dense_tiles.h"
#include "solver/linear/panel_layout.h"

namespace cleave {

// C (24, 8) -= A (24, depth) B (8, depth)^T; a, c: in row panels, b: a group of eight rows of a row panel.
inline void subtract_panel_product(int depth, const double* a, const double* b, double* c) {
  dense_tiles().subtract_panel_product(depth, a, b, c);
}

// Rows first_row.. (a multiple of 8) of C (24, 8) <- C W^T for an 8x8 lower triangular W within a row panel.
inline void multiply_panel_by_transpose(const double* w, int first_row, double* c) {
  dense_tiles().multiply_panel_by_transpose(w, first_row, c);
}

// y (24) -= P (24, columns) x
inline void subtract_panel_vector(int columns, const double* panel, const double* x, double* y) {
  dense_tiles().subtract_panel_vector(columns, panel, x, y);
}

// x (columns) -= P (24, columns)^T y
inline void subtract_panel_transpose(int columns, const double* panel, const double* y, double* x) {
  dense_tiles().subtract_panel_transpose(columns, panel, y, x);
}

}  // namespace cleave
