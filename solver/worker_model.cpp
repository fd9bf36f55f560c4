#include "solver/worker_model.h"

#include <algorithm>
#include <functional>
#include <numeric>

namespace cleave {

void RecordedSolve::clear() {
  task_ms.clear();
  stages.clear();
  backgrounds.clear();
}

// One worker is what was measured.
void WorkerModel::model(RecordedSolve& solve, StageTimes& times) {
  change_ms_.fill(0);
  background_end_ms_.fill(0);
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= solve.stages.size(); ++i) {
    for (const RecordedSolve::Background& background : solve.backgrounds) {
      if (background.first_stage == i) begin_background(background);
      if (background.end_stage == i) join_background(background);
    }
    if (i == solve.stages.size()) break;
    const std::span<double> tasks(solve.task_ms.data() + begin, solve.stages[i].end - begin);
    begin = solve.stages[i].end;
    if (tasks.size() > 1 || solve.stages[i].graph != nullptr) model_stage(solve.stages[i], tasks);
  }
  for (std::size_t k = 0; k < kModelWorkers.size(); ++k) times.model_ms[k] = solve.total_ms + change_ms_[k];
  times.critical_path_ms = solve.total_ms + change_ms_.back();
}

void WorkerModel::begin_background(const RecordedSolve::Background& background) {
  for (std::size_t k = 1; k < change_ms_.size(); ++k) {
    const double begin_ms = background.begin_ms + change_ms_[k];
    background_end_ms_[k] = begin_ms + background.ms + 1e-3 * dispatch_.stage_us;
    change_ms_[k] -= background.ms;
  }
}

void WorkerModel::join_background(const RecordedSolve::Background& background) {
  for (std::size_t k = 1; k < change_ms_.size(); ++k) change_ms_[k] += busy_ms(k, background.join_ms);
}

// How long the background task goes on after this moment of the measured solve. NaN where costs are unknown.
double WorkerModel::busy_ms(std::size_t k, double moment_ms) const {
  return std::max(background_end_ms_[k] - (moment_ms + change_ms_[k]), 0.0);
}

// Less what the tasks took, plus what they would take on so many workers.
void WorkerModel::model_stage(const RecordedSolve::Stage& stage, std::span<double> task_ms) {
  const TaskGraph* graph = stage.graph;
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
  for (std::size_t k = 1; k < kModelWorkers.size(); ++k) {
    const int workers = kModelWorkers[k];
    const double busy = busy_ms(k, stage.end_ms - on_one_ms);
    is_longest = is_longest || workers - (busy > 0 ? 1 : 0) >= static_cast<int>(task_ms.size());
    const double taken_ms = is_longest         ? longest_ms
                            : graph == nullptr ? makespan_ms(task_ms, workers, worker_ms_, busy)
                                               : schedule_.makespan_ms(workers, busy);
    is_longest = taken_ms <= longest_ms;
    change_ms_[k] += taken_ms - gain_ms;
  }
  change_ms_.back() += longest_ms - gain_ms;
}

}  // namespace cleave
