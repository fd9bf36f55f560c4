#include "solver/worker_team.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace cleave {
namespace {

// Runs a callable as the tasks of a stage.
template <class Callable>
void run(WorkerTeam& team, int count, Callable task) {
  team.run(
      count, [](void* context, int index) { (*static_cast<Callable*>(context))(index); }, &task);
}

TEST(WorkerTeamTest, RunsEveryTaskOnce) {
  for (const int threads : {1, 2, 3, 8}) {
    WorkerTeam team(threads);
    for (const int count : {0, 1, 2, 7, 1000}) {
      std::vector<std::atomic<int>> runs(count);
      run(team, count, [&](int i) { ++runs[i]; });
      for (int i = 0; i < count; ++i) EXPECT_EQ(runs[i], 1) << threads << " threads, task " << i;
    }
  }
}

// Stages of different sizes in quick succession: a thread that comes late must not touch the next stage's
// tasks.
TEST(WorkerTeamTest, KeepsStagesApart) {
  WorkerTeam team(4);
  std::atomic<int> stage = 0;
  for (int k = 0; k < 20000; ++k) {
    stage = k;
    std::atomic<int> sum = 0;
    const int count = 1 + k % 5;
    run(team, count, [&](int i) {
      if (stage == k) sum += i + 1;
    });
    ASSERT_EQ(sum, count * (count + 1) / 2) << "stage " << k;
  }
}

TEST(WorkerTeamTest, ATaskMayWaitForAnEarlierOne) {
  for (const int threads : {1, 2, 5}) {
    WorkerTeam team(threads);
    std::atomic<int> done = 0;
    std::vector<int> order;
    run(team, 500, [&](int i) {
      wait_until(done, i);
      order.push_back(i);  // one at a time, because each waits for the one before
      raise(done);
    });
    ASSERT_EQ(order.size(), 500u);
    for (int i = 0; i < 500; ++i) EXPECT_EQ(order[i], i);
  }
}

// Longer than anyone looks out, at every place where a thread may sleep: between stages, at the end of a
// stage, for an earlier task, and before the team goes.
TEST(WorkerTeamTest, WakesThreadsThatFellAsleep) {
  const auto rest = [] { std::this_thread::sleep_for(std::chrono::milliseconds(10)); };
  for (int round = 0; round < 5; ++round) {
    WorkerTeam team(3);
    rest();
    std::atomic<int> runs = 0;
    run(team, 3, [&](int i) {
      if (i > 0) rest();
      ++runs;
    });
    EXPECT_EQ(runs, 3);
    std::atomic<int> done = 0;
    run(team, 3, [&](int i) {
      wait_until(done, i);
      rest();
      raise(done);
    });
    EXPECT_EQ(done, 3);
    rest();
  }
}

TEST(WorkerTeamTest, HandsOnTheFirstExceptionAndGoesOn) {
  for (const int threads : {1, 2, 4}) {
    WorkerTeam team(threads);
    std::string caught;
    try {
      run(team, 100, [](int i) {
        if (i == 40) throw std::runtime_error("task 40");
      });
    } catch (const std::runtime_error& error) {
      caught = error.what();
    }
    EXPECT_EQ(caught, "task 40");
    std::atomic<int> runs = 0;
    run(team, 100, [&](int) { ++runs; });
    EXPECT_EQ(runs, 100);
  }
}

TEST(WorkerTeamTest, IsSharedByThreadCount) {
  EXPECT_EQ(&WorkerTeam::shared(2), &WorkerTeam::shared(2));
  EXPECT_NE(&WorkerTeam::shared(2), &WorkerTeam::shared(3));
  EXPECT_EQ(WorkerTeam::shared(3).threads(), 3);
}

}  // namespace
}  // namespace cleave
