#include "harness/dense_speed.h"

#include <cblas.h>

#include <algorithm>
#include <limits>

#include "harness/stopwatch.h"
#include "solver/dense_cholesky.h"

namespace cleave {
namespace {

constexpr int kRows = 512;
constexpr int kTries = 3;

// Column-major; far from singular.
void fill_lower_triangle(double* matrix) {
  for (int column = 0; column < kRows; ++column)
    for (int row = column; row < kRows; ++row)
      matrix[kRows * column + row] = row == column ? kRows : 1.0 / (1 + row - column);
}

}  // namespace

std::string dense_kernel() { return std::string("OpenBLAS ") + openblas_get_corename(); }

double dense_gflop_per_s() {
  StageClock clock;
  ParallelTasks tasks(clock, 1);
  DenseCholesky cholesky;
  double best_ms = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kTries; ++i) {
    fill_lower_triangle(cholesky.resize(kRows));
    clock.start();
    Stopwatch watch;
    if (!cholesky.factor(tasks)) return std::numeric_limits<double>::quiet_NaN();
    best_ms = std::min(best_ms, watch.lap_ms());
  }
  return cholesky.mflop() / best_ms;  // Mflop a millisecond
}

}  // namespace cleave
