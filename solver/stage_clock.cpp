#include "solver/stage_clock.h"

#include <algorithm>
#include <functional>
#include <numeric>

namespace cleave {

void StageClock::start() {
  times_.stage_ms.fill(0);
  task_ms_.clear();
  stages_.clear();
  thread_ = std::this_thread::get_id();
  begin_ = Clock::now();
}

void StageClock::add(Stage stage, double milliseconds) {
  times_.stage_ms[static_cast<std::size_t>(stage)] += milliseconds;
}

void StageClock::move(Stage from, Stage to, double milliseconds) {
  add(from, -milliseconds);
  add(to, milliseconds);
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

void StageClock::model() {
  times_.model_ms.fill(times_.total_ms);
  times_.critical_path_ms = times_.total_ms;
  std::size_t begin = 0;
  for (const ParallelStage& stage : stages_) {
    const std::span<double> tasks(task_ms_.data() + begin, stage.end - begin);
    begin = stage.end;
    if (tasks.size() > 1 || stage.graph != nullptr) model_stage(stage.graph, tasks);
  }
}

// Total less what the tasks took, plus what they would take on so many workers.
void StageClock::model_stage(const TaskGraph* graph, std::span<double> task_ms) {
  const double on_one_ms = std::accumulate(task_ms.begin(), task_ms.end(), 0.0);
  const double task_us = graph == nullptr ? dispatch_.task_us : dispatch_.graph_task_us;
  for (double& task : task_ms) task += 1e-3 * (task_us - dispatch_.timing_us);
  if (graph == nullptr) {
    std::ranges::sort(task_ms, std::greater<>());
  } else {
    schedule_.begin(*graph, task_ms);
  }
  const double gain_ms = on_one_ms - 1e-3 * dispatch_.stage_us;
  const double longest_ms = graph == nullptr ? task_ms.front() : schedule_.critical_path_ms();
  // Where so many workers take no more than the longest way, neither do more of them: a schedule takes longer
  // to find than many a stage to run.
  bool is_longest = false;
  for (std::size_t k = 0; k < kModelWorkers.size(); ++k) {
    const int workers = kModelWorkers[k];
    if (workers == 1) continue;
    is_longest = is_longest || workers >= static_cast<int>(task_ms.size());
    const double taken_ms = is_longest         ? longest_ms
                            : graph == nullptr ? makespan_ms(task_ms, workers, worker_ms_)
                                               : schedule_.makespan_ms(workers);
    is_longest = taken_ms <= longest_ms;
    times_.model_ms[k] += taken_ms - gain_ms;
  }
  times_.critical_path_ms += longest_ms - gain_ms;
}

}  // namespace cleave
