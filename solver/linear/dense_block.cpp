#include "solver/linear/dense_block.h"

#include <algorithm>
#include <cmath>

#include "solver/linear/small_cholesky.h"

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

void subtract_matrix_vector(int rows, int columns, const double* a, int lda, const double* x, double* y) {
  for (int c = 0; c < columns; c += 2, a += 2 * lda) {
    const double x0 = x[c], x1 = x[c + 1];
    for (int r = 0; r < rows; ++r) y[r] -= std::fma(a[r], x0, a[r + lda] * x1);
  }
}

// Each column's sum is taken in four partial sums and a rest.
void subtract_transpose_vector(int rows, int columns, const double* a, int lda, const double* y, double* x) {
  for (int c = 0; c < columns; c += 2, a += 2 * lda) {
    double sum0[4] = {}, sum1[4] = {};
    int r = 0;
    for (; r + 4 <= rows; r += 4) {
      for (int k = 0; k < 4; ++k) {
        sum0[k] = std::fma(a[r + k], y[r + k], sum0[k]);
        sum1[k] = std::fma(a[r + k + lda], y[r + k], sum1[k]);
      }
    }
    double tail0 = 0, tail1 = 0;
    for (; r < rows; ++r) {
      tail0 += a[r] * y[r];
      tail1 += a[r + lda] * y[r];
    }
    x[c] -= (sum0[0] + sum0[1]) + (sum0[2] + sum0[3]) + tail0;
    x[c + 1] -= (sum1[0] + sum1[1]) + (sum1[2] + sum1[3]) + tail1;
  }
}

}  // namespace cleave
