#include "solver/stage_clock.h"

#include <algorithm>
#include <functional>
#include <numeric>

namespace cleave {

void StageClock::start() {
  times_.stage_ms.fill(0);
  task_ms_.clear();
  stages_.clear();
  begin_ = Clock::now();
}

void StageClock::add(Stage stage, double milliseconds) {
  times_.stage_ms[static_cast<std::size_t>(stage)] += milliseconds;
}

void StageClock::add_tasks(std::span<const double> task_ms) {
  if (!models_) return;
  task_ms_.insert(task_ms_.end(), task_ms.begin(), task_ms.end());
  stages_.push_back({task_ms_.size(), nullptr});
}

void StageClock::add_graph(const TaskGraph& graph, std::span<const double> task_ms) {
  add_tasks(task_ms);
  if (models_) stages_.back().graph = &graph;
}

StageTimes StageClock::stop() {
  times_.total_ms = std::chrono::duration<double, std::milli>(Clock::now() - begin_).count();
  if (models_) model();
  return times_;
}

// Total less what the tasks took, plus what they would take on so many workers.
void StageClock::model() {
  times_.model_ms.fill(times_.total_ms);
  std::size_t begin = 0;
  for (const ParallelStage& stage : stages_) {
    const std::span<double> tasks(task_ms_.data() + begin, stage.end - begin);
    begin = stage.end;
    if (stage.graph == nullptr) std::ranges::sort(tasks, std::greater<>());
    const double on_one_ms = std::accumulate(tasks.begin(), tasks.end(), 0.0);
    for (std::size_t k = 0; k < kModelWorkers.size(); ++k) {
      const int workers = kModelWorkers[k];
      times_.model_ms[k] += (stage.graph == nullptr ? makespan_ms(tasks, workers, worker_ms_)
                                                    : schedule_.makespan_ms(*stage.graph, tasks, workers)) -
                            on_one_ms;
    }
  }
}

}  // namespace cleave
