#include "solver/stage_clock.h"

namespace cleave {

void StageClock::start() {
  times_.stage_ms.fill(0);
  solve_.clear();
  has_background_ = false;
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
  solve_.task_ms.insert(solve_.task_ms.end(), task_ms.begin(), task_ms.end());
  solve_.stages.push_back({solve_.task_ms.size(), nullptr, elapsed_ms()});
}

void StageClock::add_graph(const TaskGraph& graph, std::span<const double> task_ms) {
  add_tasks(task_ms);
  if (models_) solve_.stages.back().graph = &graph;
}

void StageClock::begin_background() {
  if (!models_) return;
  solve_.backgrounds.push_back({.begin_ms = elapsed_ms(), .first_stage = solve_.stages.size()});
  has_background_ = true;
}

void StageClock::end_background() {
  if (!has_background_) return;
  RecordedSolve::Background& last = solve_.backgrounds.back();
  last.ms = elapsed_ms() - last.begin_ms;
}

void StageClock::join_background() {
  if (!has_background_) return;
  solve_.backgrounds.back().join_ms = elapsed_ms();
  solve_.backgrounds.back().end_stage = solve_.stages.size();
  has_background_ = false;
}

StageTimes StageClock::stop() {
  join_background();
  times_.total_ms = solve_.total_ms = elapsed_ms();
  if (models_) model_.model(solve_, times_);
  return times_;
}

}  // namespace cleave
