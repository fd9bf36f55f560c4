#include "solver/linear/tile_schedule.h"

#include <algorithm>
#include <cmath>

namespace cleave {

TileSchedule::TileSchedule(int blocks, int columns) : last_on_block_(blocks * (blocks + 1) / 2, -1) {
  for (int step = -1; step < columns - 1; ++step) {
    const int next = step + 1;
    if (step >= 0) list({step, next, next});
    list({next, next, next});
    for (int column = next; column < columns && step >= 0; ++column) {
      for (int row = std::max(column, next + 1); row < blocks; ++row) list({step, row, column});
    }
    for (int row = next + 1; row < blocks; ++row) list({next, row, next});
  }
}

void TileSchedule::list(const TileOperation& operation) {
  const auto [step, row, column] = operation;
  const int index = static_cast<int>(operations_.size());
  const auto wait_for = [&](int earlier) {
    if (earlier >= 0) waits_.emplace_back(earlier, index);
  };
  wait_for(last_on(row, column));
  if (column > step) {
    wait_for(last_on(row, step));
    if (row != column) wait_for(last_on(column, step));
  } else if (row > step) {
    wait_for(last_on(step, step));
  }
  last_on_block_[row * (row + 1) / 2 + column] = index;
  operations_.push_back(operation);
}

// The fractions of multiples of the golden ratio.
double TileSchedule::place(int operation) const {
  constexpr double kGoldenRatio = 0.6180339887498949;
  const double turns = operations_[operation].row * kGoldenRatio;
  return turns - std::floor(turns);
}

}  // namespace cleave
