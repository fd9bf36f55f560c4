#include "solver/linear/dense_block.h"

#include "solver/linear/small_cholesky.h"
#include "solver/linear/vector_lanes.h"

namespace cleave {

bool eliminate_columns(int rows, int columns, double* a, int lda) {
  for (int k = 0; k < columns; ++k) {
    double* diagonal = a + 6 * k + 6L * k * lda;
    if (k > 0) subtract_product(6 * (rows - k), 6 * k, a + 6 * k, lda, a + 6 * k, lda, diagonal, lda);
    if (!invert_cholesky<6>(diagonal, lda, diagonal, lda)) return false;
    multiply_by_transpose(6 * (rows - k - 1), diagonal, lda, diagonal + 6, lda);
  }
  return true;
}

// Two columns at a time are rounded together, the six of a block on one way through y.
void subtract_matrix_vector(int rows, int columns, const double* a, int lda, const double* x, double* y) {
  for (int c = 0; c < columns; c += 6, a += 6L * lda) {
    const auto subtract = [&]<int Lanes>(int r, Vector<Lanes> part) {
      for (int i = 0; i < 6; i += 2) {
        const double* column = a + r + static_cast<long>(i) * lda;
        const Vector<Lanes> second = load<Lanes>(column + lda) * all<Lanes>(x[c + i + 1]);
        part -= multiply_add<Lanes>(load<Lanes>(column), all<Lanes>(x[c + i]), second);
      }
      store<Lanes>(y + r, part);
    };
    const int whole = rows / 4 * 4;
    for (int r = 0; r < whole; r += 4) subtract.operator()<4>(r, load_halves(y + r));
    if (whole < rows) subtract.operator()<2>(whole, load<2>(y + whole));
  }
}

// Each column's sum is taken in four partial sums and a rest, those of a block on one way through y.
void subtract_transpose_vector(int rows, int columns, const double* a, int lda, const double* y, double* x) {
  const int whole = rows / 4 * 4;
  for (int c = 0; c < columns; c += 6, a += 6L * lda) {
    Vector<4> sum[6] = {};
    for (int r = 0; r < whole; r += 4) {
      const Vector<4> part = load_halves(y + r);
      for (int i = 0; i < 6; ++i) sum[i] = multiply_add<4>(load<4>(a + r + i * lda), part, sum[i]);
    }
    double tail[6] = {};
    for (int r = whole; r < rows; ++r) {
      for (int i = 0; i < 6; ++i) tail[i] += a[r + i * lda] * y[r];
    }
    for (int i = 0; i < 6; i += 2) {
      const Vector<4> in_pairs = _mm256_hadd_pd(sum[i], sum[i + 1]);
      const Vector<2> all_four = _mm256_castpd256_pd128(in_pairs) + _mm256_extractf128_pd(in_pairs, 1);
      store<2>(x + c + i, load<2>(x + c + i) - (all_four + Vector<2>{tail[i], tail[i + 1]}));
    }
  }
}

// Whole columns are vectors, of which every second one goes into another sum.
void multiply_lower(const double* w, int ldw, double* x) {
  Vector<4> top[2] = {};
  Vector<2> bottom[2] = {};
  for (int c = 0; c < 6; ++c, w += ldw) {
    top[c % 2] = multiply_add<4>(load<4>(w), all<4>(x[c]), top[c % 2]);
    bottom[c % 2] = multiply_add<2>(load<2>(w + 4), all<2>(x[c]), bottom[c % 2]);
  }
  store<4>(x, top[0] + top[1]);
  store<2>(x + 4, bottom[0] + bottom[1]);
}

void add_columns(int rows, int columns, const double* a, int lda, double* c, int ldc) {
  const int whole = rows / 4 * 4;
  for (int column = 0; column < columns; ++column, a += lda, c += ldc) {
    for (int r = 0; r < whole; r += 4) store<4>(c + r, load<4>(c + r) + load<4>(a + r));
    if (whole < rows) store<2>(c + whole, load<2>(c + whole) + load<2>(a + whole));
  }
}

// Two whole columns at a time, whose sums are taken in pairs.
void multiply_upper(const double* w, int ldw, double* x) {
  const Vector<4> top = load_halves(x);
  const Vector<2> bottom = load<2>(x + 4);
  for (int c = 0; c < 6; c += 2, w += 2L * ldw) {
    const Vector<4> in_pairs = _mm256_hadd_pd(load<4>(w) * top, load<4>(w + ldw) * top);
    const Vector<2> below = _mm_hadd_pd(load<2>(w + 4) * bottom, load<2>(w + ldw + 4) * bottom);
    const Vector<2> above = _mm256_castpd256_pd128(in_pairs) + _mm256_extractf128_pd(in_pairs, 1);
    store<2>(x + c, above + below);
  }
}

}  // namespace cleave
