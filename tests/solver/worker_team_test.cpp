#include "solver/worker_team.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdlib>
#include <functional>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/solver/seeded_random.h"

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

// Runs a callable as the tasks of a graph.
template <class Callable>
void run(WorkerTeam& team, const TaskGraph& graph, Callable task) {
  team.run(
      graph, [](void* context, int index) { (*static_cast<Callable*>(context))(index); }, &task);
}

TaskGraph chain(int count) {
  std::vector<std::pair<int, int>> waits;
  for (int i = 0; i + 1 < count; ++i) waits.emplace_back(i, i + 1);
  TaskGraph graph;
  graph.build(count, waits);
  return graph;
}

TEST(WorkerTeamTest, RunsAChainInItsOrder) {
  for (const int threads : {1, 2, 5}) {
    WorkerTeam team(threads);
    std::vector<int> order;
    run(team, chain(500),
        [&](int i) { order.push_back(i); });  // one at a time, as each waits for the one before
    ASSERT_EQ(order.size(), 500u);
    for (int i = 0; i < 500; ++i) EXPECT_EQ(order[i], i);
  }
}

TaskGraph random_graph(int seed) {
  SeededRandom random(seed);
  const int count = random.integer(1, 60);
  std::set<std::pair<int, int>> waits;
  std::vector<double> places;
  for (int later = 0; later < count; ++later) {
    for (int k = random.integer(0, 3); k > 0 && later > 0; --k)
      waits.emplace(random.integer(0, later - 1), later);
    places.push_back(random.uniform(0, 1));
  }
  TaskGraph graph;
  graph.build(count, std::vector<std::pair<int, int>>(waits.begin(), waits.end()),
              seed % 2 == 0 ? std::span<const double>() : places);
  return graph;
}

TEST(WorkerTeamTest, EveryTaskOfAGraphComesOnceAndAfterThoseItWaitsFor) {
  for (const int threads : {1, 2, 3, 7}) {
    WorkerTeam team(threads);
    for (int seed = 0; seed < 300; ++seed) {
      team.shuffle(seed % 3 == 0 ? seed : 0);
      const TaskGraph graph = random_graph(seed);
      std::vector<std::atomic<int>> waits(graph.task_count()), runs(graph.task_count());
      for (int i = 0; i < graph.task_count(); ++i) waits[i] = graph.wait_count(i);
      std::atomic<int> early = 0;
      run(team, graph, [&](int i) {
        early += waits[i] != 0;
        ++runs[i];
        for (const int next : graph.next(i)) --waits[next];
      });
      EXPECT_EQ(early, 0) << "seed " << seed;
      for (int i = 0; i < graph.task_count(); ++i) ASSERT_EQ(runs[i], 1) << "seed " << seed << ", task " << i;
    }
  }
}

TEST(WorkerTeamTest, ShufflingChangesTheOrder) {
  WorkerTeam team(1);
  TaskGraph graph;
  graph.build(50, {});
  std::set<std::vector<int>> orders;
  for (const int seed : {0, 1, 2}) {
    team.shuffle(seed);
    std::vector<int> order;
    run(team, graph, [&](int i) { order.push_back(i); });
    orders.insert(order);
  }
  EXPECT_EQ(orders.size(), 3u);
}

// Longer than anyone looks out, at every place where a thread may sleep: between stages, at the end of a
// stage, while a task of a graph is waited for, and before the team goes.
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
    run(team, chain(3), [&](int) {
      rest();
      ++runs;
    });
    EXPECT_EQ(runs, 6);
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

TEST(WorkerTeamTest, HandsOnAnExceptionOfAGraph) {
  for (const int threads : {1, 2, 4}) {
    WorkerTeam team(threads);
    int runs = 0;
    const auto fail_at_40 = [&](int i) {
      ++runs;
      if (i == 40) throw std::runtime_error("task 40");
    };
    EXPECT_THROW(run(team, chain(100), fail_at_40), std::runtime_error);
    EXPECT_EQ(runs, 41);
    run(team, chain(100), [&](int) { ++runs; });
    EXPECT_EQ(runs, 141);
  }
}

TEST(WorkerTeamTest, DoesABackgroundTaskOnceBesideStages) {
  for (const int threads : {1, 2, 3}) {
    WorkerTeam team(threads);
    for (int round = 0; round < 2000; ++round) {
      std::atomic<int> done = 0, runs = 0;
      BackgroundTask task;
      task.work = [&] { ++done; };
      team.begin(task);
      for (int stage = 0; stage < round % 4; ++stage) run(team, 5, [&](int) { ++runs; });
      if (round % 3 == 0) run(team, chain(3), [&](int) { ++runs; });
      team.finish(task);
      ASSERT_EQ(done, 1) << threads << " threads, round " << round;
      ASSERT_EQ(runs, 5 * (round % 4) + (round % 3 == 0 ? 3 : 0));
      team.finish(task);  // there is none any more
      ASSERT_EQ(done, 1);
    }
  }
}

// It ends only after the stage has.
TEST(WorkerTeamTest, ABackgroundTaskHoldsUpNoStage) {
  WorkerTeam team(2);
  std::atomic<bool> is_begun = false, may_end = false;
  BackgroundTask task;
  task.work = [&] {
    is_begun = true;
    while (!may_end) std::this_thread::yield();
  };
  team.begin(task);
  while (!is_begun) std::this_thread::yield();
  std::atomic<int> runs = 0;
  run(team, 100, [&](int) { ++runs; });
  EXPECT_EQ(runs, 100);
  may_end = true;
  team.finish(task);
}

// Another thread than the caller's does it from now on.
void begin_elsewhere(WorkerTeam& team, BackgroundTask& task, std::function<void()> work) {
  std::atomic<bool> is_begun = false;
  task.work = [&is_begun, work = std::move(work)] {
    is_begun = true;
    work();
  };
  team.begin(task);
  while (!is_begun) std::this_thread::yield();
}

TEST(WorkerTeamTest, HandsOnAnExceptionOfABackgroundTask) {
  const auto fail = [] { throw std::runtime_error("background"); };
  WorkerTeam alone(1), two(2);
  BackgroundTask task;
  task.work = fail;
  alone.begin(task);
  EXPECT_THROW(alone.finish(task), std::runtime_error);
  alone.finish(task);  // there is none any more
  for (int round = 0; round < 20; ++round) {
    begin_elsewhere(two, task, fail);
    if (round % 2 == 0) run(two, 3, [](int) {});
    EXPECT_THROW(two.finish(task), std::runtime_error);
    begin_elsewhere(two, task, fail);
    two.cancel(task);
    two.finish(task);
  }
}

TEST(WorkerTeamTest, ACancelledBackgroundTaskDoesNotRunOn) {
  WorkerTeam alone(1), two(2);
  int runs = 0;
  BackgroundTask task;
  task.work = [&] { ++runs; };
  alone.begin(task);
  alone.cancel(task);
  EXPECT_EQ(runs, 0);
  for (int round = 0; round < 20; ++round) {
    bool has_ended = false;
    begin_elsewhere(two, task, [&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      has_ended = true;
    });
    two.cancel(task);
    EXPECT_TRUE(has_ended);
  }
}

// Which of them the other thread does is not said.
TEST(WorkerTeamTest, BackgroundTasksOfTwoCallersAreBothDone) {
  WorkerTeam team(2);
  for (int round = 0; round < 500; ++round) {
    std::atomic<int> done = 0;
    BackgroundTask first, second;
    first.work = second.work = [&] { ++done; };
    team.begin(first);
    team.begin(second);
    team.finish(second);
    team.finish(first);
    ASSERT_EQ(done, 2) << "round " << round;
  }
}

TEST(WorkerTeamTest, IsSharedByThreadCount) {
  EXPECT_EQ(&WorkerTeam::shared(2), &WorkerTeam::shared(2));
  EXPECT_NE(&WorkerTeam::shared(2), &WorkerTeam::shared(3));
  EXPECT_EQ(WorkerTeam::shared(3).threads(), 3);
}

// Leaves this process no byte to allocate.
void take_all_memory() {
  const rlimit no_more{0, 0};
  if (::setrlimit(RLIMIT_AS, &no_more) != 0) std::abort();
  for (std::size_t size = 1 << 20; size >= 8; size /= 2)
    while (std::malloc(size) != nullptr) continue;
}

TEST(WorkerTeamDeathTest, IsDismissedWithoutMemory) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  const auto dismiss_without_memory = [] {
    std::optional<WorkerTeam> team(std::in_place, 3);
    run(*team, 10, [](int) {});
    take_all_memory();
    team.reset();
    std::_Exit(EXIT_SUCCESS);
  };
  EXPECT_EXIT(dismiss_without_memory(), ::testing::ExitedWithCode(EXIT_SUCCESS), "");
}

}  // namespace
}  // namespace cleave
