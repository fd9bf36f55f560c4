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
  times_.stage_ms.fill(0);
  task_ms_.clear();
  stage_end_.clear();
  begin_ = Clock::now();
}

void StageClock::add(Stage stage, double milliseconds) {
  times_.stage_ms[static_cast<std::size_t>(stage)] += milliseconds;
}

void StageClock::add_tasks(std::span<const double> task_ms) {
  if (!models_) return;
  task_ms_.insert(task_ms_.end(), task_ms.begin(), task_ms.end());
  stage_end_.push_back(task_ms_.size());
}

StageTimes StageClock::stop() {
  times_.total_ms = std::chrono::duration<double, std::milli>(Clock::now() - begin_).count();
  if (models_) model();
  return times_;
}

// Total less what the tasks took, plus what they would take on so many workers.
void StageClock::model() {
  times_.model_ms.fill(times_.total_ms);
  for (std::size_t stage = 0, begin = 0; stage < stage_end_.size(); begin = stage_end_[stage++]) {
    const std::span<double> tasks(task_ms_.data() + begin, stage_end_[stage] - begin);
    std::ranges::sort(tasks, std::greater<>());
    const double on_one_ms = makespan_ms(tasks, 1, worker_ms_);
    for (std::size_t k = 0; k < kModelWorkers.size(); ++k) {
      times_.model_ms[k] += makespan_ms(tasks, kModelWorkers[k], worker_ms_) - on_one_ms;
    }
  }
}

}  // namespace cleave
