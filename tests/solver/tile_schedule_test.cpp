// Every block sees every step once and in order, and waits, if only through others, for all that it reads.
#include "solver/linear/tile_schedule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

namespace cleave {
namespace {

using Block = std::pair<int, int>;  // row, column

struct Case {
  int blocks, columns, joined_steps;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const int blocks : {1, 2, 3, 7, 12, 17})
    for (int columns = 1; columns <= blocks; ++columns)
      for (const int joined_steps : {1, 2, 3, 4}) all.push_back({blocks, columns, joined_steps});
  return all;
}

TEST(TileSchedule, UpdatesEveryBlockByEveryStepInOrder) {
  for (const auto& [blocks, columns, joined_steps] : cases()) {
    std::map<Block, int> next_step;
    const TileSchedule schedule(blocks, columns, joined_steps);
    for (const TileOperation& operation : schedule.operations()) {
      int& next = next_step[{operation.row, operation.column}];
      EXPECT_EQ(operation.step, next);
      EXPECT_TRUE(operation.steps == 1 || operation.step + operation.steps <= operation.column);
      next += operation.steps;
    }
    for (int column = 0; column < columns; ++column)
      for (int row = column; row < blocks; ++row) EXPECT_EQ((next_step[{row, column}]), column + 1);
    EXPECT_EQ(std::ssize(next_step), columns * (2 * blocks - columns + 1) / 2);
  }
}

// By operation: which others it comes after.
std::vector<std::vector<bool>> earlier_operations(const TileSchedule& schedule) {
  const std::size_t count = schedule.operations().size();
  std::vector<std::vector<bool>> earlier(count, std::vector<bool>(count, false));
  std::vector<std::vector<int>> waits(count);
  for (const auto& [first, second] : schedule.waits()) waits[second].push_back(first);
  for (std::size_t k = 0; k < count; ++k)
    for (const int before : waits[k]) {
      EXPECT_LT(before, static_cast<int>(k));
      earlier[k][before] = true;
      for (std::size_t i = 0; i < count; ++i) earlier[k][i] = earlier[k][i] || earlier[before][i];
    }
  return earlier;
}

TEST(TileSchedule, WaitsForAllThatIsRead) {
  for (const auto& [blocks, columns, joined_steps] : cases()) {
    const TileSchedule schedule(blocks, columns, joined_steps);
    const std::vector<std::vector<bool>> earlier = earlier_operations(schedule);
    std::map<Block, int> last;  // operation on a block
    for (int k = 0; k < std::ssize(schedule.operations()); ++k) {
      const auto [step, row, column, steps] = schedule.operations()[k];
      const auto is_after = [&, k = k](Block block) { return earlier[k][last.at(block)]; };
      if (last.contains({row, column})) {
        EXPECT_TRUE(is_after({row, column}));
      }
      if (column == step && row > step) {
        EXPECT_TRUE(is_after({step, step}));
      }
      for (int from = step; column > step && from < step + steps; ++from) {
        EXPECT_TRUE(is_after({row, from})) << row << " " << column << " " << from;
        EXPECT_TRUE(is_after({column, from})) << row << " " << column << " " << from;
      }
      last[{row, column}] = k;
      EXPECT_LE(k, schedule.last_on(row, column));
    }
  }
}

TEST(TileSchedule, JoinsStepsFarFromABlocksTurn) {
  const TileSchedule by_steps(40, 40), by_fours(40, 40, 4);
  const auto single = by_steps.operations().size(), joined = by_fours.operations().size();
  EXPECT_EQ(single, 40 * 41 * 42 / 6);
  EXPECT_LT(joined, 6 * single / 10);
}

}  // namespace
}  // namespace cleave
