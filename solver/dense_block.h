// Dense kernels on blocks of six columns: the inner loops of the block Cholesky factorisation.
//
// All matrices are column-major; `ld` is the distance between columns. Row counts are even (bodies have six
// rows, right-hand sides are padded to an even number). The products are tiled 8 x 6 in registers: one column
// of the tile pair costs two loads and six broadcasts for twelve fused multiply-adds. These loops are the one
// place where multiply-adds are fused (see the compile option of this file); the order of additions is fixed.
#pragma once

namespace cleave {

// C (rows, 6) -= A (rows, depth) * B (6, depth)^T
void subtract_product(int rows, int depth, const double* a, int lda, const double* b, int ldb, double* c,
                      int ldc);

// C (rows, 6) <- C * W^T for a 6x6 lower triangular W.
void multiply_by_transpose(int rows, const double* w, int ldw, double* c, int ldc);

// Factors the 6x6 block A = L L^T (lower triangle read, ld lda) and writes W = L^-1 (6x6 column-major, upper
// part zero). Returns false when a pivot is not positive or not a number.
bool invert_cholesky(const double* a, int lda, double* w);

// H (12, 12, column-major, all blocks on and below the diagonal blocks) = sum_r d_r j_r^T j_r over `rows`
// Jacobian rows of 12, skipping rows with d_r = 0. Returns false when all were skipped (H is then not
// written).
bool weighted_gram(int rows, const double* jacobian, const double* d, double* h);

// y (rows) -= A (rows, columns) x, and x (columns) -= A^T y; an even number of columns.
void subtract_matrix_vector(int rows, int columns, const double* a, int lda, const double* x, double* y);
void subtract_transpose_vector(int rows, int columns, const double* a, int lda, const double* y, double* x);

}  // namespace cleave
