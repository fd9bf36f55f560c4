// Models of solves that are written down by hand; those of clocks: stage_clock_test.cpp.
#include "solver/worker_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace cleave {
namespace {

// As the model has them: workers 1, 2, 4, ... and as many as there are tasks.
constexpr std::size_t kTwo = 1, kFour = 2, kSixteen = 4;

StageTimes model(RecordedSolve solve, const DispatchCost& dispatch = {}) {
  StageTimes times;
  WorkerModel(dispatch).model(solve, times);
  EXPECT_EQ(times.model_ms[0], solve.total_ms);
  return times;
}

// A background task from 1 ms on, then 2 ms of serial time and two stages of four tasks of 1 ms with 1 ms
// between them. It is needed where the second ends, and 5 ms of serial time follow.
RecordedSolve two_stages_beside(double background_ms) {
  RecordedSolve solve;
  solve.backgrounds = {{.begin_ms = 1, .ms = background_ms, .join_ms = 12 + background_ms, .end_stage = 2}};
  solve.task_ms.assign(8, 1.0);
  solve.stages = {{4, nullptr, 7 + background_ms}, {8, nullptr, 12 + background_ms}};
  solve.total_ms = 17 + background_ms;
  return solve;
}

// Two workers: it ends at 4, 1 ms into the first stage, in which three tasks go to the free worker and one to
// the other, so that it takes 3 ms. The second stage takes 2.
TEST(WorkerModelTest, ABackgroundTaskHasAWorkerToItself) {
  const StageTimes times = model(two_stages_beside(3));
  EXPECT_NEAR(times.model_ms[kTwo], 1 + 2 + 3 + 1 + 2 + 5, 1e-12);
  EXPECT_NEAR(times.model_ms[kFour], 1 + 2 + 2 + 1 + 1 + 5, 1e-12);  // three are free at first, then all
  EXPECT_NEAR(times.model_ms[kSixteen], 1 + 2 + 1 + 1 + 1 + 5, 1e-12);
  EXPECT_NEAR(times.critical_path_ms, 1 + 2 + 1 + 1 + 1 + 5, 1e-12);
}

// It ends at 101, and nothing else until 6 (two workers: one of them does all tasks), 4 or 3.
TEST(WorkerModelTest, WhoNeedsItWaitsForIt) {
  const StageTimes times = model(two_stages_beside(100));
  for (const std::size_t k : {kTwo, kFour, kSixteen}) EXPECT_NEAR(times.model_ms[k], 1 + 100 + 5, 1e-12);
  EXPECT_NEAR(times.critical_path_ms, 1 + 100 + 5, 1e-12);
}

TEST(WorkerModelTest, SerialTimeHidesIt) {
  const StageTimes times = model(two_stages_beside(2));
  EXPECT_NEAR(times.model_ms[kTwo], 1 + 2 + 2 + 1 + 2 + 5, 1e-12);
  EXPECT_NEAR(times.critical_path_ms, 1 + 2 + 1 + 1 + 1 + 5, 1e-12);
}

TEST(WorkerModelTest, ItCostsWhatAStageDoes) {
  const DispatchCost dispatch{.timing_us = 0, .task_us = 0, .graph_task_us = 0, .stage_us = 250};
  EXPECT_NEAR(model(two_stages_beside(100), dispatch).model_ms[kTwo], 1 + 100 + 0.25 + 5, 1e-12);
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  RecordedSolve alone = two_stages_beside(3);
  alone.task_ms.clear();
  alone.stages.clear();
  alone.backgrounds[0].end_stage = 0;
  const StageTimes unknown = model(alone, {kNan, kNan, kNan, kNan});
  EXPECT_TRUE(std::isnan(unknown.model_ms[kTwo]));
  EXPECT_TRUE(std::isnan(unknown.critical_path_ms));
}

// The next one begins where the first has been waited for.
TEST(WorkerModelTest, OneBackgroundTaskComesAfterTheOther) {
  RecordedSolve solve = two_stages_beside(3);
  solve.backgrounds.push_back({.begin_ms = 15, .ms = 4, .join_ms = 19, .first_stage = 2, .end_stage = 2});
  solve.total_ms += 4;
  EXPECT_NEAR(model(solve).critical_path_ms, 1 + 2 + 1 + 1 + 1 + 4 + 5, 1e-12);  // nothing is beside it
}

}  // namespace
}  // namespace cleave
