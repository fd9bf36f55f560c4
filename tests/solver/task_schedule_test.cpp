// Schedules of task graphs, against bounds that hold for every schedule, a slow twin and cases done by hand.
#include "solver/task_schedule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "tests/solver/seeded_random.h"

namespace cleave {
namespace {

using Waits = std::vector<std::pair<int, int>>;

TaskGraph graph_of(int count, const Waits& waits) {
  TaskGraph graph;
  graph.build(count, waits);
  return graph;
}

double makespan(const TaskGraph& graph, const std::vector<double>& task_ms, int workers, double busy_ms = 0) {
  GraphSchedule schedule;
  schedule.begin(graph, task_ms);
  return schedule.makespan_ms(workers, busy_ms);
}

// The rule to the letter: looks at all tasks and all workers whenever one ends.
double makespan_by_rule(const TaskGraph& graph, const std::vector<double>& task_ms, int workers,
                        double busy_ms = 0) {
  const int count = graph.task_count();
  std::vector<double> way_ms(task_ms), end_ms(count, -1);
  std::vector<int> waits(count);
  for (int task = count - 1; task >= 0; --task) {
    waits[task] = graph.wait_count(task);
    double after_ms = 0;
    for (const int next : graph.next(task)) after_ms = std::max(after_ms, way_ms[next]);
    way_ms[task] += after_ms;
  }
  std::set<std::pair<double, int>> running;
  if (busy_ms > 0) running.emplace(busy_ms, -1);
  double now_ms = 0;
  for (int left = count; left > 0;) {
    while (static_cast<int>(running.size()) < workers) {
      int best = -1;
      for (int task = 0; task < count; ++task)
        if (waits[task] == 0 && end_ms[task] < 0 && (best < 0 || way_ms[task] > way_ms[best])) best = task;
      if (best < 0) break;
      running.emplace(end_ms[best] = now_ms + task_ms[best], best);
    }
    const auto [end, task] = *running.begin();
    running.erase(running.begin());
    now_ms = end;
    if (task < 0) continue;
    --left;
    for (const int next : graph.next(task)) --waits[next];
  }
  return now_ms;
}

TEST(GraphScheduleTest, CasesByHand) {
  EXPECT_EQ(makespan(graph_of(0, {}), {}, 2), 0);
  EXPECT_EQ(makespan(graph_of(3, {{0, 1}, {1, 2}}), {1, 2, 4}, 5), 7);  // a chain
  EXPECT_EQ(makespan(graph_of(3, {{0, 2}, {1, 2}}), {3, 2, 4}, 2), 7);  // two leaves and their parent
  EXPECT_EQ(makespan(graph_of(3, {{0, 2}, {1, 2}}), {3, 2, 4}, 1), 9);
  EXPECT_EQ(makespan(graph_of(4, {{0, 3}}), {1, 4, 4, 6}, 2),
            8);  // the long way goes first: 1, 6 beside 4, 4
  EXPECT_EQ(makespan(graph_of(5, {{0, 2}, {1, 2}, {2, 3}, {2, 4}}), {1, 2, 3, 4, 5}, 2), 10);
}

TEST(GraphScheduleTest, AWorkerWithSomethingElseToDoComesLater) {
  const TaskGraph chain = graph_of(3, {{0, 1}, {1, 2}}), apart = graph_of(4, {});
  EXPECT_EQ(makespan(chain, {1, 2, 4}, 2, 100), 7);   // which is not waited for
  EXPECT_EQ(makespan(chain, {1, 2, 4}, 1, 3), 10);    // there is no other
  EXPECT_EQ(makespan(apart, {2, 2, 2, 2}, 2, 3), 6);  // three beside it and one after it, which ends at 5
  EXPECT_EQ(makespan(apart, {2, 2, 2, 2}, 2, 8), 8);  // all beside it
  EXPECT_EQ(makespan(apart, {2, 2, 2, 2}, 4, 1), 3);  // the fourth begins at 1
  EXPECT_EQ(makespan(apart, {2, 2, 2, 2}, 5, 1000), 2);
  std::vector<double> scratch;
  EXPECT_EQ(makespan_ms(std::vector<double>{2, 2, 2, 2}, 2, scratch, 3), 6);
  EXPECT_EQ(makespan_ms(std::vector<double>{2, 2, 2, 2}, 2, scratch, 8), 8);
  EXPECT_EQ(makespan_ms(std::vector<double>{4, 1}, 2, scratch, 2), 4);
  EXPECT_EQ(makespan_ms(std::vector<double>{4, 1}, 2, scratch, 9), 5);
}

TEST(GraphScheduleTest, LiesBetweenTheBoundsOfEverySchedule) {
  for (int seed = 0; seed < 300; ++seed) {
    SeededRandom random(seed);
    const int count = random.integer(1, 200);
    std::set<std::pair<int, int>> waits;
    std::vector<double> task_ms(count);
    for (int later = 0; later < count; ++later) {
      task_ms[later] =
          random.integer(0, 1) == 0 ? random.log_uniform(1e-3, 10) : random.integer(1, 3);  // ties too
      for (int k = random.integer(0, 2); k > 0 && later > 0; --k)
        waits.emplace(random.integer(0, later - 1), later);
    }
    const TaskGraph graph = graph_of(count, Waits(waits.begin(), waits.end()));
    GraphSchedule schedule;
    const double sum = std::accumulate(task_ms.begin(), task_ms.end(), 0.0);
    schedule.begin(graph, task_ms);
    const double path = schedule.critical_path_ms();
    EXPECT_GE(path, *std::ranges::max_element(task_ms)) << "seed " << seed;
    EXPECT_NEAR(schedule.makespan_ms(1), sum, 1e-12 * sum) << "seed " << seed;
    EXPECT_NEAR(schedule.makespan_ms(count), path, 1e-12 * sum) << "seed " << seed;
    for (const int workers : {2, 3, 8}) {
      const double found = schedule.makespan_ms(workers);
      EXPECT_EQ(found, makespan_by_rule(graph, task_ms, workers)) << "seed " << seed;
      const double busy_ms = random.log_uniform(1e-3, 100);
      EXPECT_EQ(schedule.makespan_ms(workers, busy_ms), makespan_by_rule(graph, task_ms, workers, busy_ms))
          << "seed " << seed << ", busy for " << busy_ms << " ms";
      EXPECT_GE(found, std::max(path, sum / workers) * (1 - 1e-12)) << "seed " << seed;
      EXPECT_LE(found, (sum / workers + path) * (1 + 1e-12)) << "seed " << seed;  // Graham 1969
    }
  }
}

}  // namespace
}  // namespace cleave
