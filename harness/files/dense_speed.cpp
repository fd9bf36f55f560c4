#include "harness/files/dense_speed.h"

#include <algorithm>
#include <limits>

#include "harness/base/stopwatch.h"
#include "solver/linear/dense_cholesky.h"
#include "solver/linear/dense_tiles.h"

namespace cleave {
namespace {

constexpr int kRows = 512;
constexpr int kTries = 3;

// Far from singular.
void fill(DenseCholesky& cholesky) {
  cholesky.resize(kRows);
  const auto entry = [](int row, int column) { return row == column ? kRows : 1.0 / (1 + row - column); };
  for (int p = 0; p < cholesky.panel_count(); ++p) cholesky.fill_panel(p, entry);
}

}  // namespace

std::string dense_instruction_set() { return dense_tiles().name; }

double dense_gflop_per_s() {
  StageClock clock;
  ParallelTasks tasks(clock, 1);
  DenseCholesky cholesky;
  double best_ms = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kTries; ++i) {
    fill(cholesky);
    clock.start();
    Stopwatch watch;
    if (!cholesky.factor(tasks)) return std::numeric_limits<double>::quiet_NaN();
    best_ms = std::min(best_ms, watch.lap_ms());
  }
  return cholesky.mflop() / best_ms;  // Mflop a millisecond
}

}  // namespace cleave
