// How long the tasks of a parallel stage take on p workers: list schedules of Graham 1969. Communication between
// workers is left out.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "solver/task_graph.h"

namespace cleave {

// Of independent tasks: the longest goes first to the worker that is free first. worker_ms is scratch.
double makespan_ms(std::span<const double> sorted_descending_ms, int workers, std::vector<double>& worker_ms);

// Of a graph: whenever a worker is free, it takes of the tasks that are ready the one with the longest way to the end
// (its own time and the longest of those that wait for it).
class GraphSchedule {
 public:
  double makespan_ms(const TaskGraph& graph, std::span<const double> task_ms, int workers);
  // The longest way through the graph: the makespan on as many workers as there are tasks.
  double critical_path_ms(const TaskGraph& graph, std::span<const double> task_ms);

 private:
  std::vector<double> way_ms_;
  std::vector<int> waits_;
  std::vector<std::pair<double, int>> ready_, running_;  // heaps: (way, task), (end, task)
};

}  // namespace cleave
