// Dense kernels on blocks of six columns: the inner loops of the block Cholesky factorisation.
//
// All matrices are column-major; `ld` is the distance between columns. Row counts are even (bodies have six
// rows, right-hand sides are padded to an even number). Products run in register tiles (dense_tiles.h); the
// order of additions is fixed and which multiply-adds are fused is written out, so all instruction sets give
// the same bytes.
#pragma once

#include "solver/linear/dense_tiles.h"

namespace cleave {

// C (rows, 6) -= A (rows, depth) * B (6, depth)^T
inline void subtract_product(int rows, int depth, const double* a, int lda, const double* b, int ldb,
                             double* c, int ldc) {
  dense_tiles().subtract_product(rows, depth, a, lda, b, ldb, c, ldc);
}

// The same from zero: what is in C does not matter.
inline void write_negative_product(int rows, int depth, const double* a, int lda, const double* b, int ldb,
                                   double* c, int ldc) {
  dense_tiles().write_negative_product(rows, depth, a, lda, b, ldb, c, ldc);
}

// C (rows, 6) <- C * W^T for a 6x6 lower triangular W.
inline void multiply_by_transpose(int rows, const double* w, int ldw, double* c, int ldc) {
  dense_tiles().multiply_by_transpose(rows, w, ldw, c, ldc);
}

// H (12, 12, column-major, all blocks on and below the diagonal blocks; of one body the first block) = sum_r
// d_r j_r^T j_r over `rows` Jacobian rows of 12, skipping rows with d_r = 0. Returns false when all were
// skipped (H is then not written).
inline bool weighted_gram(int bodies, int rows, const double* jacobian, const double* d, double* h) {
  return dense_tiles().weighted_gram(bodies, rows, jacobian, d, h);
}

// A (6 rows, 6 columns), its first block a diagonal one, <- those columns of the Cholesky factor, with the
// inverse of every 6x6 diagonal block in the block's place; rows and columns in blocks. False when a pivot is
// not positive.
bool eliminate_columns(int rows, int columns, double* a, int lda);

// C (rows, columns) += A
void add_columns(int rows, int columns, const double* a, int lda, double* c, int ldc);

// y (rows) -= A (rows, columns) x, and x (columns) -= A^T y; whole blocks of columns. Vectors are read two
// numbers at a time or one, and stored two at a time or four, so that blocks of six that one call has written
// are read by the next without waiting for memory.
void subtract_matrix_vector(int rows, int columns, const double* a, int lda, const double* x, double* y);
void subtract_transpose_vector(int rows, int columns, const double* a, int lda, const double* y, double* x);

// x (6) <- W x and W^T x for a 6x6 lower triangular W with zeros above.
void multiply_lower(const double* w, int ldw, double* x);
void multiply_upper(const double* w, int ldw, double* x);

}  // namespace cleave
