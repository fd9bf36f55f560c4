// Cholesky factorisation of a dense symmetric positive definite matrix: the interface system of schur-rows.
//
// The lower triangle is stored in row panels (dense_panel.h): panel p holds rows 24 p .. 24 p + 23 and their
// columns up to the diagonal, so that factor and solves run on it without copies, in half the memory of a
// square matrix. Rows beyond the size are rows of the identity. The blocks of kBlock rows are factored as
// tile_schedule.h says. The inverse of each 8x8 diagonal block of L is stored in the place of the block.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <new>
#include <span>
#include <vector>

#include "solver/linear/panel_layout.h"
#include "solver/linear/tile_schedule.h"
#include "solver/parallel_tasks.h"

namespace cleave {

class DenseCholesky {
 public:
  // A matrix of this size, to be filled panel by panel. Memory only grows.
  void resize(int size);
  // What resize and factor allocate for this size.
  static void count(int size, MemoryCount& memory);
  int size() const { return size_; }
  int panel_count() const { return panels_; }

  // Sets panel p to zero, rows beyond the size to those of the identity, and returns it: entry (r, c) of the
  // matrix is at (r - 24 p) + 24 c, c <= r. Panels may be filled by different threads.
  double* begin_panel(int p);

  // The same, and fills it with entry(row, column) of the matrix.
  template <class Entry>
  void fill_panel(int p, const Entry& entry) {
    double* entries = begin_panel(p);
    const int first = kPanelRows * p, end = size_ < first + kPanelRows ? size_ : first + kPanelRows;
    for (int row = first; row < end; ++row) {
      for (int column = 0; column <= row; ++column) {
        entries[row - first + static_cast<std::ptrdiff_t>(kPanelRows) * column] = entry(row, column);
      }
    }
  }

  // False when a pivot is not positive. Throws Stopped at the next block where the solve is to stop.
  bool factor(ParallelTasks& tasks);
  void solve(std::span<double> x);  // x (size) <- A^-1 x

  // Multiplications and additions of one factorisation, 1e6: the sum of squared column heights.
  double mflop() const { return size_ * (size_ + 1.0) * (2.0 * size_ + 1) / 6 * 1e-6; }

 private:
  struct FreeAligned {
    void operator()(double* p) const { ::operator delete[](p, std::align_val_t(64)); }
  };
  double* panel(int p) const { return entries_.get() + offset(p); }
  static std::size_t offset(long p) {
    return std::size_t{kPanelRows * kPanelRows / 2} * static_cast<std::size_t>(p * (p + 1));
  }

  // Of all sizes with the same number of blocks; stays once it is there, as the clock of a solve refers to
  // it.
  struct Schedule {
    explicit Schedule(int blocks);

    TileSchedule tiles;
    TaskGraph graph;
  };
  const Schedule& schedule();

  bool factor_diagonal(int step);
  void solve_below(int step, int row);
  void update(int step, int row, int column);
  int panels_until(int block) const;

  int size_ = 0, panels_ = 0, blocks_ = 0;
  std::size_t capacity_ = 0;
  std::unique_ptr<double[], FreeAligned> entries_;
  std::vector<double> padded_;                        // a right-hand side and zeros up to a whole panel
  std::vector<std::unique_ptr<Schedule>> schedules_;  // by number of blocks
};

}  // namespace cleave
