#include "solver/linear/tile_schedule.h"

#include <algorithm>
#include <cmath>

namespace cleave {

TileSchedule::TileSchedule(int blocks, int columns, int joined_steps)
    : last_on_block_(blocks * (blocks + 1) / 2, -1) {
  for (int step = -1; step < columns - 1; ++step) {
    const int next = step + 1;
    if (step >= 0) list({step, next, next});
    list({next, next, next});
    for (int column = next; column < columns && step >= 0; ++column)
      list_updates(step, column, std::max(column, next + 1), blocks, joined_steps);
    for (int row = next + 1; row < blocks; ++row) list({next, row, next});
  }
}

// By this step, or by those that end with it; none where these are not complete.
void TileSchedule::list_updates(int step, int column, int first_row, int blocks, int joined_steps) {
  const int single_from = joined_steps * std::max(0, column / joined_steps - 1);
  const int steps = step < single_from ? joined_steps : 1;
  if ((step + 1) % steps != 0) return;
  for (int row = first_row; row < blocks; ++row) list({step + 1 - steps, row, column, steps});
}

void TileSchedule::list(const TileOperation& operation) {
  const auto [first_step, row, column, steps] = operation;
  const int step = first_step + steps - 1;  // whose blocks wait for those of the steps before
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
