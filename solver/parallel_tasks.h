// Runs the tasks 0..count-1 of one stage of a solve on the solver's threads and reports their times.
//
// Tasks write only to their own slot, so results do not depend on the number of threads. Times of single
// tasks are taken on one thread only: with more, they would contain each other's memory traffic and whatever
// else runs on the machine.
#pragma once

#include <immintrin.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <numeric>
#include <span>
#include <vector>

#include "harness/base/stop.h"
#include "solver/memory_count.h"
#include "solver/stage_clock.h"
#include "solver/worker_team.h"

namespace cleave {

// Keeps all threads busy for a tenth of a second, in which the scheduler spreads them over the cores. Without
// it the first solve of a process took 30 ms for 0.3: all its threads ran on one core.
void start_threads(int threads);

class ParallelTasks {
 public:
  ParallelTasks(StageClock& clock, int threads, const std::atomic<bool>* stop = nullptr,
                std::uint64_t memory_limit_bytes = kNoMemoryLimit)
      : clock_(clock), team_(WorkerTeam::shared(threads)), stop_(stop), memory_(memory_limit_bytes) {}

  // In any order: no task may wait for another.
  template <class Task>
  void run(Stage stage, int count, const Task& task) {
    StageTimer timer(clock_, stage);
    run(count, task);
  }

  // In whatever stage is being timed.
  template <class Task>
  void run(int count, const Task& task) {
    if (count == 1) {
      task(0);
    } else if (team_.threads() == 1) {
      run_alone(count, task);
      clock_.add_tasks(task_ms_);
    } else {
      team_.run(count, call<Task>, context_of(task));
    }
  }

  // task(chunk) of each chunk.
  template <class Chunk, class Task>
  void run_over(std::span<const Chunk> chunks, const Task& task) {
    run(static_cast<int>(chunks.size()), [&](int i) { task(chunks[i]); });
  }

  // The same of two lists, in one stage.
  template <class Chunk, class FirstTask, class SecondTask>
  void run_over(std::span<const Chunk> first, const FirstTask& first_task, std::span<const Chunk> second,
                const SecondTask& second_task) {
    const int count = static_cast<int>(first.size());
    run(count + static_cast<int>(second.size()),
        [&](int i) { i < count ? first_task(first[i]) : second_task(second[i - count]); });
  }

  // The tasks of a graph, which must stay as it is until the solve has ended.
  template <class Task>
  void run(Stage stage, const TaskGraph& graph, const Task& task) {
    StageTimer timer(clock_, stage);
    if (is_shared()) {
      team_.run(graph, call<Task>, context_of(task));
    } else {
      run_alone(graph.task_count(), task);
      clock_.add_graph(graph, task_ms_);
    }
  }

  // The same; those tasks for which is_other(index) count as another stage, with their share of the time of
  // all threads.
  template <class Task, class IsOther>
  void run(Stage stage, const TaskGraph& graph, const Task& task, Stage other, const IsOther& is_other) {
    bool counts = false;
    double other_ms = 0;
    {
      const StageTimer timer(clock_, stage);
      counts = timer.counts();
      if (is_shared()) {
        other_ms = run_shared(graph, task, is_other);
      } else {
        run_timed(graph.task_count(), task);
        for (int i = 0; i < graph.task_count(); ++i)
          if (is_other(i)) other_ms += task_ms_[i];
        clock_.add_graph(graph, task_ms_);
      }
    }
    if (counts) clock_.move(stage, other, other_ms);
  }

  // Work that runs no tasks of its own, done on another thread beside the stages that follow; no two at once.
  // On one thread it is done here and now.
  void begin_background(std::function<void()> work);
  // Nothing where there is none. The time it is waited for is that of a stage. Throws what it threw.
  void finish_background(Stage stage);
  // For one whose results nobody waits for any more: returns once it is not running.
  void cancel_background();

  StageClock& clock() { return clock_; }
  int threads() const { return team_.threads(); }
  const std::atomic<bool>* stop() const { return stop_; }  // of the solve
  MemoryBudget& memory() { return memory_; }               // of the solve

 private:
  template <class Task>
  static void call(void* context, int index) {
    (*static_cast<const Task*>(context))(index);
  }
  template <class Task>
  static void* context_of(const Task& task) {
    return const_cast<void*>(static_cast<const void*>(&task));
  }

  // How long a tick of the processor's counter takes, by the clock, from when it was made.
  class TickTimer {
   public:
    double ms_per_tick() const {
      const double ms = std::chrono::duration<double, std::milli>(StageClock::Clock::now() - begin_).count();
      return ms / static_cast<double>(std::max<std::uint64_t>(__rdtsc() - tick_, 1));
    }

   private:
    StageClock::Clock::time_point begin_ = StageClock::Clock::now();
    std::uint64_t tick_ = __rdtsc();
  };

  bool is_shared() const { return team_.threads() > 1 || team_.shuffles(); }

  template <class Task, class IsOther>
  double run_shared(const TaskGraph& graph, const Task& task, const IsOther& is_other) {
    task_ms_.assign(graph.task_count(), 0.0);
    const auto run_one = [&](int i) {
      if (!is_other(i)) return task(i);
      const std::uint64_t tick = __rdtsc();
      task(i);
      task_ms_[i] = static_cast<double>(__rdtsc() - tick);
    };
    const TickTimer timer;
    team_.run(graph, call<decltype(run_one)>, context_of(run_one));
    const double ticks = std::accumulate(task_ms_.begin(), task_ms_.end(), 0.0);
    return ticks * timer.ms_per_tick() / team_.threads();
  }

  // Timed where that is modelled.
  template <class Task>
  void run_alone(int count, const Task& task) {
    if (clock_.models()) return run_timed(count, task);
    for (int i = 0; i < count; ++i) task(i);
  }

  // Tasks of small problems take a fifth of a microsecond, and reading the clock is a tenth of that: between
  // them it is the processor's counter that is read, and its ticks are given out of the time of all of them.
  template <class Task>
  void run_timed(int count, const Task& task) {
    task_ms_.resize(count);
    const TickTimer timer;
    std::uint64_t tick = __rdtsc();
    for (int i = 0; i < count; ++i) {
      task(i);
      const std::uint64_t next = __rdtsc();
      task_ms_[i] = static_cast<double>(next - tick);
      tick = next;
    }
    const double ms_per_tick = timer.ms_per_tick();
    for (double& ms : task_ms_) ms *= ms_per_tick;
  }

  StageClock& clock_;
  WorkerTeam& team_;
  BackgroundTask background_;
  const std::atomic<bool>* stop_;
  MemoryBudget memory_;
  std::vector<double> task_ms_;
};

}  // namespace cleave
