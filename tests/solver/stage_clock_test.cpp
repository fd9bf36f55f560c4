#include "solver/stage_clock.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <thread>

#include "tests/solver/seeded_random.h"

namespace cleave {
namespace {

double makespan(std::vector<double> tasks, int workers) {
  std::sort(tasks.rbegin(), tasks.rend());
  std::vector<double> scratch;
  return makespan_ms(tasks, workers, scratch);
}

double milliseconds_since(StageClock::Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(StageClock::Clock::now() - begin).count();
}

void spin_ms(double milliseconds) {
  const auto begin = StageClock::Clock::now();
  while (milliseconds_since(begin) < milliseconds) {
  }
}

TEST(MakespanTest, GivesTheLongestTaskFirstSchedule) {
  EXPECT_EQ(makespan({}, 3), 0);
  EXPECT_EQ(makespan({4}, 1), 4);
  EXPECT_EQ(makespan({4}, 8), 4);
  EXPECT_EQ(makespan({1, 2, 3, 4}, 1), 10);
  EXPECT_EQ(makespan({1, 2, 3, 4}, 2), 5);              // 4+1, 3+2
  EXPECT_EQ(makespan({5, 4, 3, 3, 3}, 2), 10);          // 5+3, 4+3+3: not the best possible 9
  EXPECT_EQ(makespan({2, 14, 4, 16, 6, 5, 7}, 3), 18);  // 16+2, 14+4, 7+6+5
  EXPECT_EQ(makespan({1, 1, 1, 1, 1}, 4), 2);
}

TEST(MakespanTest, IsNeverBelowTheLongestTask) {
  EXPECT_EQ(makespan({9, 1, 1, 1}, 2), 9);   // 1+1+1 beside it
  EXPECT_EQ(makespan({9, 1, 1, 1}, 4), 9);   // one each
  EXPECT_EQ(makespan({9, 1, 1, 1}, 16), 9);  // twelve workers idle
  EXPECT_EQ(makespan({3, 2, 1}, 3), 3);
  EXPECT_EQ(makespan({0, 0}, 2), 0);
}

TEST(MakespanTest, LiesBetweenTheBoundsOfEverySchedule) {
  for (int seed = 0; seed < 200; ++seed) {
    SeededRandom random(seed);
    std::vector<double> tasks(random.integer(1, 40));
    for (double& task : tasks) task = random.log_uniform(1e-3, 10);
    const double sum = std::accumulate(tasks.begin(), tasks.end(), 0.0);
    const double longest = *std::max_element(tasks.begin(), tasks.end());
    EXPECT_NEAR(makespan(tasks, 1), sum, 1e-12 * sum) << "seed " << seed;
    double before = sum * (1 + 1e-12);
    for (const int workers : {2, 4, 8, 16}) {
      const double found = makespan(tasks, workers);
      const double least = std::max(longest, sum / workers);
      EXPECT_GE(found, least * (1 - 1e-12)) << "seed " << seed;
      EXPECT_LE(found, sum / workers + longest * (1 + 1e-12)) << "seed " << seed;
      EXPECT_LE(found, before) << "seed " << seed;
      before = found;
    }
  }
}

TEST(StageClockTest, ModelsParallelStagesAndKeepsSerialTime) {
  StageClock clock;
  clock.start();
  spin_ms(12);
  clock.add(Stage::factor_local, 10);
  clock.add_tasks(std::vector<double>{1, 2, 3, 4});  // makespans 10, 5, 4, 4, 4
  clock.add_tasks({});                               // a stage without tasks
  clock.add_tasks(std::vector<double>{1, 1});        // makespans 2, 1, 1, 1, 1
  const StageTimes times = clock.stop();
  EXPECT_GE(times.total_ms, 12);
  EXPECT_NEAR(times.total_ms - times.model_ms[1], 12 - 6, 1e-9);
  EXPECT_NEAR(times.total_ms - times.model_ms[2], 12 - 5, 1e-9);
  EXPECT_NEAR(times.total_ms - times.model_ms[3], 12 - 5, 1e-9);
  EXPECT_NEAR(times.total_ms - times.model_ms[4], 12 - 5, 1e-9);
  EXPECT_NEAR(times.total_ms - times.critical_path_ms, 12 - 5, 1e-9);
}

// On two workers 3 ms become 1.5, and every task costs 0.3 - 0.1 ms more, every stage 0.25; a single task is
// the caller's.
TEST(StageClockTest, ChargesDispatchOnMoreThanOneWorker) {
  StageClock clock(1, {.timing_us = 100, .task_us = 300, .graph_task_us = 1100, .stage_us = 250});
  TaskGraph chain;
  chain.build(3, std::vector<std::pair<int, int>>{{0, 1}, {1, 2}});
  clock.start();
  spin_ms(20);
  clock.add_tasks(std::vector<double>{1, 1, 1});
  clock.add_tasks(std::vector<double>{5});
  clock.add_graph(chain, std::vector<double>{1, 2, 3});
  clock.add_tasks({});
  const StageTimes times = clock.stop();
  const auto gain_ms = [&](double model_ms) { return times.total_ms - model_ms; };
  const double chain_ms = -(0.25 + 3 * 1.0);
  EXPECT_EQ(times.model_ms[0], times.total_ms);
  EXPECT_NEAR(gain_ms(times.model_ms[1]), 3 - (0.25 + 2 * 1.2) + chain_ms, 1e-9);
  EXPECT_NEAR(gain_ms(times.model_ms[2]), 3 - (0.25 + 1.2) + chain_ms, 1e-9);
  EXPECT_NEAR(gain_ms(times.model_ms.back()), 3 - (0.25 + 1.2) + chain_ms, 1e-9);
  EXPECT_NEAR(gain_ms(times.critical_path_ms), 3 - (0.25 + 1.2) + chain_ms, 1e-9);
}

// Serial time that is at least as long hides it, whether it is waited for or ends with the solve.
TEST(StageClockTest, ModelsABackgroundTaskBesideSerialTime) {
  StageClock clock;
  for (const bool joins : {true, false}) {
    clock.start();
    const auto begin = StageClock::Clock::now();
    clock.begin_background();
    spin_ms(1);
    clock.end_background();
    const double most_ms = milliseconds_since(begin);
    spin_ms(2 * most_ms);
    if (joins) clock.join_background();
    clock.join_background();  // there is none any more
    const StageTimes times = clock.stop();
    EXPECT_EQ(times.model_ms[0], times.total_ms);
    for (const double model_ms : {times.model_ms[1], times.model_ms.back(), times.critical_path_ms}) {
      EXPECT_GE(times.total_ms - model_ms, 1 - 1e-9) << joins;
      EXPECT_LE(times.total_ms - model_ms, most_ms + 1e-9) << joins;
    }
  }
}

TEST(StageClockTest, ABackgroundTaskThatIsNeededAtOnceGainsLittle) {
  StageClock clock;
  clock.start();
  clock.begin_background();
  spin_ms(1);
  const auto end = StageClock::Clock::now();
  clock.end_background();
  clock.join_background();
  const double most_ms = milliseconds_since(end);
  const StageTimes times = clock.stop();
  EXPECT_GE(times.total_ms - times.model_ms[1], -1e-9);
  EXPECT_LE(times.total_ms - times.model_ms[1], most_ms + 1e-9);
}

// Where the cost is not known, one worker is still what was measured.
TEST(StageClockTest, ModelsNoMoreWorkersWithoutTheCostOfDispatch) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  StageClock clock(1, {kNan, kNan, kNan, kNan});
  TaskGraph pair;
  pair.build(2, {});
  clock.start();
  clock.add_tasks(std::vector<double>{1, 2, 3});
  clock.add_graph(pair, std::vector<double>{1, 2});
  const StageTimes times = clock.stop();
  EXPECT_EQ(times.model_ms[0], times.total_ms);
  for (std::size_t k = 1; k < kModelWorkers.size(); ++k) EXPECT_TRUE(std::isnan(times.model_ms[k]));
  EXPECT_TRUE(std::isnan(times.critical_path_ms));
}

// Stages wait for each other: one list of all tasks would give 8 on two workers.
TEST(StageClockTest, SchedulesEveryStageByItself) {
  StageClock clock;
  clock.start();
  spin_ms(17);
  clock.add_tasks(std::vector<double>{1, 8});
  clock.add_tasks(std::vector<double>{7, 1});
  const StageTimes times = clock.stop();
  EXPECT_NEAR(times.total_ms - times.model_ms[1], 17 - (8 + 7), 1e-9);
}

// Tasks that ran side by side take longer than alone, and their sum is not wall time.
TEST(StageClockTest, ModelsNothingOfMoreThreads) {
  StageClock clock(2);
  clock.start();
  clock.add_tasks(std::vector<double>{1, 2, 3, 4});
  const StageTimes times = clock.stop();
  EXPECT_GT(times.total_ms, 0);
  for (const double model_ms : times.model_ms) EXPECT_TRUE(std::isnan(model_ms));
  EXPECT_TRUE(std::isnan(times.critical_path_ms));
}

TEST(StageClockTest, NothingIsMeasuredBeforeItStarts) {
  const StageTimes times;
  EXPECT_TRUE(std::isnan(times.total_ms));
  for (const double stage_ms : times.stage_ms) EXPECT_TRUE(std::isnan(stage_ms));
  for (const double model_ms : times.model_ms) EXPECT_TRUE(std::isnan(model_ms));
}

TEST(StageClockTest, AddsUpStagesAndStartsAfresh) {
  StageClock clock;
  clock.start();
  clock.add(Stage::solve, 1);
  clock.add(Stage::solve, 2);
  clock.add(Stage::check, 4);
  const StageTimes first = clock.stop();
  EXPECT_EQ(first.stage_ms[static_cast<std::size_t>(Stage::solve)], 3);
  EXPECT_EQ(first.stage_ms[static_cast<std::size_t>(Stage::check)], 4);
  EXPECT_EQ(first.stage_ms[static_cast<std::size_t>(Stage::analyze)], 0);

  clock.start();
  spin_ms(1);
  clock.add_tasks(std::vector<double>{0.5, 0.25});
  const StageTimes second = clock.stop();
  EXPECT_EQ(second.stage_ms[static_cast<std::size_t>(Stage::solve)], 0);
  EXPECT_NEAR(second.total_ms - second.model_ms[1], 0.25, 1e-9);
}

TEST(StageClockTest, TimerAddsTheTimeOfItsScope) {
  StageClock clock;
  clock.start();
  {
    const StageTimer timer(clock, Stage::refine);
    spin_ms(2);
  }
  const StageTimes times = clock.stop();
  const double refine_ms = times.stage_ms[static_cast<std::size_t>(Stage::refine)];
  EXPECT_GE(refine_ms, 2);
  EXPECT_LE(refine_ms, times.total_ms);
}

TEST(StageClockTest, TimersOfOtherThreadsAddNothing) {
  StageClock clock;
  clock.start();
  std::thread([&clock] {
    const StageTimer timer(clock, Stage::refine);
    spin_ms(1);
  }).join();
  EXPECT_EQ(clock.stop().stage_ms[static_cast<std::size_t>(Stage::refine)], 0);
}

}  // namespace
}  // namespace cleave
