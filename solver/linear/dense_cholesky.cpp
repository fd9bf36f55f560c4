#include "solver/linear/dense_cholesky.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "harness/base/ceil_div.h"
#include "solver/linear/dense_panel.h"
#include "solver/linear/small_cholesky.h"

namespace cleave {
namespace {

// Panels of a block. The bytes of the factor depend on it, so it is the same on every machine.
constexpr int kBlockPanels = 5;
constexpr int kBlock = kBlockPanels * kPanelRows;
constexpr int kBlockGroups = kBlock / kPanelColumns;  // groups of eight rows or columns
constexpr int kPanelGroups = kPanelRows / kPanelColumns;
constexpr long kGroupEntries = kPanelRows * kPanelColumns;  // of eight columns of a panel

// x (24) <- L^-1 x on the diagonal of a panel, a group of eight rows after the other.
void solve_diagonal(const double* diagonal, double* x) {
  for (int first = 0; first < kPanelRows; first += kPanelColumns) {
    double y[kPanelColumns] = {};
    for (int c = 0; c < kPanelColumns; ++c) {
      const double* column = diagonal + kPanelRows * (first + c) + first;
      for (int r = c; r < kPanelColumns; ++r) y[r] = std::fma(column[r], x[first + c], y[r]);
    }
    std::copy(y, y + kPanelColumns, x + first);
    for (int c = first; c < first + kPanelColumns; ++c) {
      const double* column = diagonal + kPanelRows * c;
      for (int r = first + kPanelColumns; r < kPanelRows; ++r) x[r] = std::fma(-column[r], x[c], x[r]);
    }
  }
}

// x (24) <- L^-T x
void solve_diagonal_transpose(const double* diagonal, double* x) {
  for (int first = kPanelRows - kPanelColumns; first >= 0; first -= kPanelColumns) {
    for (int c = first; c < first + kPanelColumns; ++c) {
      const double* column = diagonal + kPanelRows * c;
      for (int r = first + kPanelColumns; r < kPanelRows; ++r) x[c] = std::fma(-column[r], x[r], x[c]);
    }
    double y[kPanelColumns] = {};
    for (int c = 0; c < kPanelColumns; ++c) {
      const double* column = diagonal + kPanelRows * (first + c) + first;
      for (int r = c; r < kPanelColumns; ++r) y[c] = std::fma(column[r], x[first + r], y[c]);
    }
    std::copy(y, y + kPanelColumns, x + first);
  }
}

}  // namespace

void DenseCholesky::resize(int size) {
  size_ = size;
  panels_ = ceil_div(size, kPanelRows);
  blocks_ = ceil_div(panels_, kBlockPanels);
  if (offset(panels_) > capacity_) {
    capacity_ = 0;  // until there is memory: a solver that found none may be asked again
    entries_.reset();
    entries_.reset(new (std::align_val_t(64)) double[offset(panels_)]);
    capacity_ = offset(panels_);
  }
}

// A schedule has an operation for every three blocks row >= column >= step; it waits for at most three
// others. Both lists grow as they are filled. Beyond what an int numbers there is no schedule, whatever
// memory there is.
void DenseCholesky::count(int size, MemoryCount& memory) {
  const long panels = ceil_div(size, kPanelRows);
  const auto blocks = static_cast<std::uint64_t>(ceil_div(panels, long{kBlockPanels}));
  memory.add<double>(offset(panels));
  memory.add<double>(kPanelRows, panels);
  const std::uint64_t operations = blocks * (blocks + 1) * (blocks + 2) / 6;
  if (operations > std::numeric_limits<int>::max() / 3) return memory.add<char>(kNoMemoryLimit);
  constexpr std::uint64_t kOperationBytes = 2 * sizeof(TileOperation) + 2 * 3 * sizeof(std::pair<int, int>) +
                                            2 * sizeof(double) + 2 * 6 * sizeof(int) + 2 * sizeof(double);
  memory.add<char>(operations, kOperationBytes);
}

double* DenseCholesky::begin_panel(int p) {
  double* entries = panel(p);
  std::fill(entries, entries + (offset(p + 1) - offset(p)), 0.0);
  for (int r = std::max(0, size_ - kPanelRows * p); r < kPanelRows; ++r) {
    entries[r + kPanelRows * (kPanelRows * p + r)] = 1;
  }
  return entries;
}

int DenseCholesky::panels_until(int block) const { return std::min(panels_, block * kBlockPanels); }

// Eight columns at a time; each is updated by those before it in the block.
bool DenseCholesky::factor_diagonal(int step) {
  const int first = step * kBlockPanels, last = panels_until(step + 1);
  const long start = static_cast<long>(kPanelRows) * step * kBlock;
  for (int g = 0; g < (last - first) * kPanelGroups; ++g) {
    const int own = first + g / kPanelGroups, own_row = g % kPanelGroups * kPanelColumns;
    const long columns = start + kGroupEntries * g;
    const double* right = panel(own) + start + own_row;
    for (int p = own; p < last; ++p) {
      subtract_panel_product(kPanelColumns * g, panel(p) + start, right, panel(p) + columns);
    }
    double* diagonal = panel(own) + columns + own_row;
    if (!invert_cholesky<kPanelColumns>(diagonal, kPanelRows, diagonal, kPanelRows)) return false;
    multiply_panel_by_transpose(diagonal, own_row + kPanelColumns, panel(own) + columns);
    for (int p = own + 1; p < last; ++p) multiply_panel_by_transpose(diagonal, 0, panel(p) + columns);
  }
  return true;
}

void DenseCholesky::solve_below(int step, int row) {
  const long start = static_cast<long>(kPanelRows) * step * kBlock;
  for (int p = row * kBlockPanels; p < panels_until(row + 1); ++p) {
    for (int g = 0; g < kBlockGroups; ++g) {
      const double* right = panel(step * kBlockPanels + g / kPanelGroups) + g % kPanelGroups * kPanelColumns;
      const long columns = start + kGroupEntries * g;
      subtract_panel_product(kPanelColumns * g, panel(p) + start, right + start, panel(p) + columns);
      multiply_panel_by_transpose(right + columns, 0, panel(p) + columns);
    }
  }
}

void DenseCholesky::update(int step, int row, int column) {
  const long start = static_cast<long>(kPanelRows) * step * kBlock;
  for (int p = row * kBlockPanels; p < panels_until(row + 1); ++p) {
    const int end = std::min((column + 1) * kBlockGroups, (p + 1) * kPanelGroups);
    for (int g = column * kBlockGroups; g < end; ++g) {
      const double* right = panel(g / kPanelGroups) + start + g % kPanelGroups * kPanelColumns;
      subtract_panel_product(kBlock, panel(p) + start, right, panel(p) + kGroupEntries * g);
    }
  }
}

DenseCholesky::Schedule::Schedule(int blocks) : tiles(blocks, blocks) {
  std::vector<double> places;
  for (std::size_t k = 0; k < tiles.operations().size(); ++k)
    places.push_back(tiles.place(static_cast<int>(k)));
  graph.build(static_cast<int>(tiles.operations().size()), tiles.waits(), places);
}

const DenseCholesky::Schedule& DenseCholesky::schedule() {
  if (blocks_ >= static_cast<int>(schedules_.size())) schedules_.resize(blocks_ + 1);
  if (schedules_[blocks_] == nullptr) schedules_[blocks_] = std::make_unique<Schedule>(blocks_);
  return *schedules_[blocks_];
}

bool DenseCholesky::factor(ParallelTasks& tasks) {
  const Schedule& schedule = this->schedule();
  std::atomic<bool> positive = true;
  tasks.run(Stage::factor_interface, schedule.graph, [&](int index) {
    const auto [step, row, column, steps] = schedule.tiles.operations()[index];
    check_stop(tasks.stop());
    if (!positive) return;
    if (column > step) {
      for (int k = step; k < step + steps; ++k) update(k, row, column);
    } else if (row > step) {
      solve_below(step, row);
    } else if (!factor_diagonal(step)) {
      positive = false;
    }
  });
  return positive;
}

void DenseCholesky::solve(std::span<double> x) {
  padded_.assign(static_cast<std::size_t>(kPanelRows) * panels_, 0.0);
  std::copy(x.begin(), x.end(), padded_.begin());
  for (int p = 0; p < panels_; ++p) {
    double* own = padded_.data() + kPanelRows * p;
    subtract_panel_vector(kPanelRows * p, panel(p), padded_.data(), own);
    solve_diagonal(panel(p) + kPanelRows * kPanelRows * p, own);
  }
  for (int p = panels_ - 1; p >= 0; --p) {
    double* own = padded_.data() + kPanelRows * p;
    solve_diagonal_transpose(panel(p) + kPanelRows * kPanelRows * p, own);
    subtract_panel_transpose(kPanelRows * p, panel(p), own, padded_.data());
  }
  std::copy_n(padded_.begin(), size_, x.begin());
}

}  // namespace cleave
