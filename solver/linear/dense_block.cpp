#include "solver/linear/dense_block.h"

#include <algorithm>
#include <cmath>

#include "solver/linear/small_cholesky.h"
#include "solver/linear/vector_lanes.h"

namespace cleave {

bool eliminate_columns(int rows, int columns, double* a, int lda) {
  for (int k = 0; k < columns; ++k) {
    double* diagonal = a + 6 * k + 6L * k * lda;
    subtract_product(6 * (rows - k), 6 * k, a + 6 * k, lda, a + 6 * k, lda, diagonal, lda);
    double inverse[36];
    if (!invert_cholesky<6>(diagonal, lda, inverse, 6)) return false;
    multiply_by_transpose(6 * (rows - k - 1), inverse, 6, diagonal + 6, lda);
    for (int c = 0; c < 6; ++c) std::copy(inverse + 6 * c, inverse + 6 * c + 6, diagonal + c * lda);
  }
  return true;
}

// Two columns at a time are rounded together, the six of a block on one way through y.
void subtract_matrix_vector(int rows, int columns, const double* a, int lda, const double* x, double* y) {
  for (int c = 0; c < columns; c += 6, a += 6L * lda) {
    const double *a0 = a, *a1 = a0 + lda, *a2 = a1 + lda, *a3 = a2 + lda, *a4 = a3 + lda, *a5 = a4 + lda;
    const double x0 = x[c], x1 = x[c + 1], x2 = x[c + 2], x3 = x[c + 3], x4 = x[c + 4], x5 = x[c + 5];
#pragma omp simd
    for (int r = 0; r < rows; ++r) {
      const double first = y[r] - std::fma(a0[r], x0, a1[r] * x1);
      const double second = first - std::fma(a2[r], x2, a3[r] * x3);
      y[r] = second - std::fma(a4[r], x4, a5[r] * x5);
    }
  }
}

// Each column's sum is taken in four partial sums and a rest, those of a block on one way through y.
void subtract_transpose_vector(int rows, int columns, const double* a, int lda, const double* y, double* x) {
  const int whole = rows / 4 * 4;
  for (int c = 0; c < columns; c += 6, a += 6L * lda) {
    Vector<4> sum[6] = {};
    for (int r = 0; r < whole; r += 4) {
      const Vector<4> part = load<4>(y + r);
      for (int i = 0; i < 6; ++i) sum[i] = multiply_add<4>(load<4>(a + r + i * lda), part, sum[i]);
    }
    double tail[6] = {};
    for (int r = whole; r < rows; ++r) {
      for (int i = 0; i < 6; ++i) tail[i] += a[r + i * lda] * y[r];
    }
    for (int i = 0; i < 6; ++i) x[c + i] -= (sum[i][0] + sum[i][1]) + (sum[i][2] + sum[i][3]) + tail[i];
  }
}

}  // namespace cleave
