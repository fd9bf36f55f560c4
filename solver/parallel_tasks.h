// Runs independent tasks 0..count-1 of one stage on the given number of threads and reports wall and task
// times.
//
// Tasks write only to their own slot, so results do not depend on the number of threads.
#pragma once

#include <omp.h>

#include <vector>

#include "solver/stage_clock.h"

namespace cleave {

// Makes the threads and keeps them busy for a tenth of a second, in which the scheduler spreads them over the
// cores. Without it the first solve of a process took 30 ms for 0.3: all its threads ran on one core.
void start_threads(int threads);

class ParallelTasks {
 public:
  ParallelTasks(StageClock& clock, int threads) : clock_(clock), threads_(threads) {}

  template <class Task>
  void run(Stage stage, int count, const Task& task) {
    StageTimer timer(clock_, stage);
    task_ms_.resize(count);
    const auto timed = [&](int i) {
      const auto begin = StageClock::Clock::now();
      task(i);
      task_ms_[i] = std::chrono::duration<double, std::milli>(StageClock::Clock::now() - begin).count();
    };
    if (threads_ == 1 || count <= 1) {
      for (int i = 0; i < count; ++i) timed(i);
    } else {
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads_)
      for (int i = 0; i < count; ++i) timed(i);
    }
    clock_.add_tasks(task_ms_);
  }

  StageClock& clock() { return clock_; }

 private:
  StageClock& clock_;
  int threads_;
  std::vector<double> task_ms_;
};

}  // namespace cleave
