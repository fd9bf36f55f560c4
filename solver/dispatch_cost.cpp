#include "solver/dispatch_cost.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "harness/base/median.h"
#include "solver/parallel_tasks.h"
#include "solver/task_graph.h"
#include "solver/worker_team.h"

namespace cleave {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kTries = 15;
constexpr int kMostAttempts = 5;                         // to have a core for each thread all the time
constexpr int kEmptyTasks = 1023;                        // a full binary tree
constexpr std::chrono::microseconds kGap{5};             // serial work between two stages
constexpr std::chrono::microseconds kLong{20};           // a task that the other thread has time to join
constexpr std::chrono::microseconds kSpreading{500};     // a task that gets a thread its core
constexpr std::chrono::milliseconds kMostSpreading{20};  // for the scheduler to give both threads a core

void spin(Clock::duration time) {
  const auto end = Clock::now() + time;
  while (Clock::now() < end) {
  }
}

template <class Work>
double time_us(const Work& work) {
  const auto begin = Clock::now();
  work();
  return std::chrono::duration<double, std::micro>(Clock::now() - begin).count();
}

template <class Work>
double median_us(const Work& work) {
  std::array<double, kTries> times_us;
  for (double& one_us : times_us) {
    spin(kGap);
    one_us = time_us(work);
  }
  return median_in_place(times_us);
}

void empty_task(void*, int) {}
void long_task(void*, int) { spin(kLong); }
void spreading_task(void*, int) { spin(kSpreading); }

// Two equal tasks on two threads, less one of them.
double stage_us(WorkerTeam& team) {
  const double alone_us = std::chrono::duration<double, std::micro>(kLong).count();
  return median_us([&] { team.run(team.threads(), long_task, nullptr); }) - alone_us;
}

// Until two tasks take less than twice the time of one.
void spread(WorkerTeam& team) {
  constexpr double kTogether = 1.5;
  const auto end = Clock::now() + kMostSpreading;
  while (time_us([&] { team.run(team.threads(), spreading_task, nullptr); }) >
             kTogether * kSpreading.count() &&
         Clock::now() < end) {
  }
}

// Every task waits for its two children; a half of the tree belongs to each thread.
TaskGraph binary_tree() {
  std::vector<std::pair<int, int>> waits;
  std::vector<double> places(kEmptyTasks);
  const auto number = [](int node) { return kEmptyTasks - 1 - node; };  // children first
  places[number(0)] = 0;
  double width = 1;
  for (int node = 1, level_end = 1; node < kEmptyTasks; ++node) {
    if (node == level_end) level_end = 2 * level_end + 1, width /= 2;
    const int parent = (node - 1) / 2;
    waits.emplace_back(number(node), number(parent));
    places[number(node)] = places[number(parent)] + (node % 2 == 0 ? width : 0);
  }
  TaskGraph tree;
  tree.build(kEmptyTasks, waits, places);
  return tree;
}

// On one thread tasks are timed and not queued.
double timing_us() {
  StageClock clock;
  ParallelTasks tasks(clock, 1);
  return median_us([&] {
           clock.start();
           tasks.run(Stage::analyze, kEmptyTasks, [](int) {});
         }) /
         kEmptyTasks;
}

DispatchCost measure_with(WorkerTeam& team) {
  DispatchCost cost;
  cost.timing_us = timing_us();
  cost.stage_us = stage_us(team);
  // As many on each thread: the model then gives what was measured.
  const auto each_us = [&](double all_us) { return 2 * (all_us - cost.stage_us) / kEmptyTasks; };
  cost.task_us = each_us(median_us([&] { team.run(kEmptyTasks, empty_task, nullptr); }));
  const TaskGraph tree = binary_tree();
  cost.graph_task_us = each_us(median_us([&] { team.run(tree, empty_task, nullptr); }));
  return cost;
}

// Where one thread did both tasks, nothing was learnt about a stage of two.
bool were_together(const DispatchCost& cost) {
  return cost.stage_us < 0.5 * std::chrono::duration<double, std::micro>(kLong).count();
}

}  // namespace

DispatchCost measure_dispatch_cost() {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  try {
    WorkerTeam team(2);
    DispatchCost cost;
    for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
      spread(team);
      cost = measure_with(team);
      if (were_together(cost)) break;
    }
    return cost;
  } catch (const std::runtime_error&) {
    return {kNan, kNan, kNan, kNan};
  }
}

const DispatchCost& dispatch_cost() {
  static const DispatchCost cost = measure_dispatch_cost();
  return cost;
}

}  // namespace cleave
