#include "solver/dense_cholesky.h"

#include <cblas.h>

#include <algorithm>

extern "C" void dpotrf_(const char* uplo, const int* n, double* a, const int* lda, int* info);

namespace cleave {
namespace {

constexpr int kTile = 128;

}  // namespace

double* DenseCholesky::resize(int size) {
  size_ = size;
  a_.resize(static_cast<std::size_t>(size) * size);
  return a_.data();
}

void DenseCholesky::solve_below(int diagonal, int tile) {
  const int k = diagonal * kTile, i = tile * kTile;
  cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, std::min(kTile, size_ - i),
              kTile, 1.0, a_.data() + k + static_cast<long>(k) * size_, size_,
              a_.data() + i + static_cast<long>(k) * size_, size_);
}

void DenseCholesky::update_tile(int diagonal, int row_tile, int column_tile) {
  const int k = diagonal * kTile, i = row_tile * kTile, j = column_tile * kTile;
  const int rows = std::min(kTile, size_ - i), columns = std::min(kTile, size_ - j);
  const double* left = a_.data() + i + static_cast<long>(k) * size_;
  const double* right = a_.data() + j + static_cast<long>(k) * size_;
  double* target = a_.data() + i + static_cast<long>(j) * size_;
  if (row_tile == column_tile) {
    cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, rows, kTile, -1.0, left, size_, 1.0, target, size_);
  } else {
    cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, rows, columns, kTile, -1.0, left, size_, right,
                size_, 1.0, target, size_);
  }
}

bool DenseCholesky::factor(ParallelTasks& tasks) {
  const int tiles = (size_ + kTile - 1) / kTile;
  for (int k = 0; k < tiles; ++k) {
    int info = 0;
    {
      StageTimer timer(tasks.clock(), Stage::factor_interface);
      const int width = std::min(kTile, size_ - k * kTile);
      dpotrf_("L", &width, a_.data() + k * kTile + static_cast<long>(k) * kTile * size_, &size_, &info);
    }
    if (info != 0) return false;
    const int below = tiles - k - 1;
    tasks.run(Stage::factor_interface, below, [&](int t) { solve_below(k, k + 1 + t); });
    // Trailing tiles (i, j), k < j <= i, numbered down the columns of the triangle.
    tasks.run(Stage::factor_interface, below * (below + 1) / 2, [&](int t) {
      int column = 0;
      for (int left = below; t >= left; --left) t -= left, ++column;
      update_tile(k, k + 1 + column + t, k + 1 + column);
    });
  }
  return true;
}

void DenseCholesky::solve(std::span<double> x) const {
  if (size_ == 0) return;
  cblas_dtrsv(CblasColMajor, CblasLower, CblasNoTrans, CblasNonUnit, size_, a_.data(), size_, x.data(), 1);
  cblas_dtrsv(CblasColMajor, CblasLower, CblasTrans, CblasNonUnit, size_, a_.data(), size_, x.data(), 1);
}

}  // namespace cleave
