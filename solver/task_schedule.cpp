#include "solver/task_schedule.h"

#include <algorithm>
#include <functional>

namespace cleave {

double makespan_ms(std::span<const double> sorted_descending_ms, int workers,
                   std::vector<double>& worker_ms) {
  worker_ms.assign(workers, 0.0);
  for (double task : sorted_descending_ms) *std::min_element(worker_ms.begin(), worker_ms.end()) += task;
  return *std::max_element(worker_ms.begin(), worker_ms.end());
}

double GraphSchedule::critical_path_ms(const TaskGraph& graph, std::span<const double> task_ms) {
  way_ms_.assign(task_ms.begin(), task_ms.end());
  double longest_ms = 0;
  for (int task = graph.task_count() - 1; task >= 0; --task) {
    double after_ms = 0;
    for (const int next : graph.next(task)) after_ms = std::max(after_ms, way_ms_[next]);
    way_ms_[task] += after_ms;
    longest_ms = std::max(longest_ms, way_ms_[task]);
  }
  return longest_ms;
}

double GraphSchedule::makespan_ms(const TaskGraph& graph, std::span<const double> task_ms, int workers) {
  critical_path_ms(graph, task_ms);
  const auto add_ready = [&](int task) {
    ready_.emplace_back(way_ms_[task], -task);  // of two with the same way, the lower number first
    std::ranges::push_heap(ready_);
  };
  ready_.clear();
  running_.clear();
  ready_.reserve(graph.task_count());  // how many there are at once depends on the times
  running_.reserve(graph.task_count());
  waits_.resize(graph.task_count());
  for (int task = 0; task < graph.task_count(); ++task) {
    waits_[task] = graph.wait_count(task);
    if (waits_[task] == 0) add_ready(task);
  }
  double now_ms = 0;
  while (!ready_.empty() || !running_.empty()) {
    while (!ready_.empty() && static_cast<int>(running_.size()) < workers) {
      std::ranges::pop_heap(ready_);
      const int task = -ready_.back().second;
      ready_.pop_back();
      running_.emplace_back(now_ms + task_ms[task], task);
      std::ranges::push_heap(running_, std::greater<>());
    }
    std::ranges::pop_heap(running_, std::greater<>());
    const auto [end_ms, task] = running_.back();
    running_.pop_back();
    now_ms = end_ms;
    for (const int next : graph.next(task)) {
      if (--waits_[next] == 0) add_ready(next);
    }
  }
  return now_ms;
}

}  // namespace cleave
