// Tiled Cholesky factorisation of a dense symmetric positive definite matrix: the interface system of
// schur-rows.
//
// Right-looking over tiles of fixed size: factor the diagonal tile, solve the tiles below it, update the
// trailing tiles; the tiles of one phase are independent tasks, every tile is updated in the same order for
// any number of threads. Tile arithmetic is BLAS and LAPACK on one thread each. Flops counted as the sum of
// squared column heights.
#pragma once

#include <span>
#include <vector>

#include "solver/parallel_tasks.h"

namespace cleave {

class DenseCholesky {
 public:
  // Storage of the matrix (size x size, column-major, lower triangle read) for the caller to fill.
  double* resize(int size);
  int size() const { return size_; }

  bool factor(ParallelTasks& tasks);      // false when a pivot is not positive
  void solve(std::span<double> x) const;  // x (size) <- A^-1 x

  double mflop() const { return size_ * (size_ + 1.0) * (2.0 * size_ + 1) / 6 * 1e-6; }

 private:
  void solve_below(int diagonal, int tile);
  void update_tile(int diagonal, int row_tile, int column_tile);

  int size_ = 0;
  std::vector<double> a_;
};

}  // namespace cleave
