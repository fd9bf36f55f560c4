// How long the tasks of a parallel stage take on p workers: list schedules of Graham 1969. Communication
// between workers is left out.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "solver/task_graph.h"

namespace cleave {

// Of independent tasks: the longest goes first to the worker that is free first. worker_ms is scratch.
// busy_ms: how long one of the workers has something else to do, here and below.
double makespan_ms(std::span<const double> sorted_descending_ms, int workers, std::vector<double>& worker_ms,
                   double busy_ms = 0);

// Of a graph: whenever a worker is free, it takes of the tasks that are ready the one with the longest way to
// the end (its own time and the longest of those that wait for it), of two with the same way that of the
// lower number.
class GraphSchedule {
 public:
  // Finds the ways. The graph and the times stay where they are until the last makespan.
  void begin(const TaskGraph& graph, std::span<const double> task_ms);
  double makespan_ms(int workers, double busy_ms = 0);
  // The longest way through the graph: the makespan on as many workers as there are tasks.
  double critical_path_ms() const { return longest_ms_; }

 private:
  // Tasks that are ready, by rank: a bit each, so that the first of them is found among 64 at once.
  void add_ready(int task);
  int take_ready();

  const TaskGraph* graph_ = nullptr;
  std::span<const double> task_ms_;
  double longest_ms_ = 0;
  std::vector<double> way_ms_;
  std::vector<int> task_of_rank_, rank_of_task_;  // by way, the longest first
  std::vector<int> waits_;
  std::vector<std::uint64_t> ready_;
  int ready_count_ = 0;
  std::size_t first_word_ = 0;                   // none before it has a bit
  std::vector<std::pair<double, int>> running_;  // a heap: (end, task)
};

}  // namespace cleave
