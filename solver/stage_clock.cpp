#include "solver/stage_clock.h"

#include <algorithm>
#include <functional>

namespace cleave {

double makespan_ms(std::span<const double> sorted_descending_ms, int workers,
                   std::vector<double>& worker_ms) {
  worker_ms.assign(workers, 0.0);
  for (double task : sorted_descending_ms) *std::min_element(worker_ms.begin(), worker_ms.end()) += task;
  return *std::max_element(worker_ms.begin(), worker_ms.end());
}

void StageClock::start() {
  times_ = StageTimes{};
  parallel_ms_ = 0;
  makespan_ms_.fill(0);
  begin_ = Clock::now();
}

void StageClock::add(Stage stage, double milliseconds) {
  times_.stage_ms[static_cast<std::size_t>(stage)] += milliseconds;
}

void StageClock::add_tasks(std::span<const double> task_ms) {
  if (task_ms.empty()) return;
  sorted_ms_.assign(task_ms.begin(), task_ms.end());
  std::sort(sorted_ms_.begin(), sorted_ms_.end(), std::greater<>());
  for (double task : sorted_ms_) parallel_ms_ += task;
  for (std::size_t k = 0; k < kModelWorkers.size(); ++k) {
    makespan_ms_[k] += makespan_ms(sorted_ms_, kModelWorkers[k], worker_ms_);
  }
}

StageTimes StageClock::stop() {
  times_.total_ms = std::chrono::duration<double, std::milli>(Clock::now() - begin_).count();
  for (std::size_t k = 0; k < kModelWorkers.size(); ++k) {
    times_.model_ms[k] = times_.total_ms - parallel_ms_ + makespan_ms_[k];
  }
  return times_;
}

}  // namespace cleave
