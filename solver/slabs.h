// Slabs of bodies, by their distance in the graph from a body at its edge: rows between two bodies are inside
// of a slab or between two that are neighbours. What a sweep over them visits, and in which order:
//
//     the insides of all slabs;   the gaps between slabs 0|1, 2|3, ...;   the gaps 1|2, 3|4, ...
//
// Each inside or gap, a set of groups of rows, waits within a sweep for those that share bodies with it
// alone. A sweep begins where that before it has ended.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "solver/prepared_step.h"
#include "solver/task_graph.h"

namespace cleave {

class Slabs {
 public:
  // Cuts the bodies, and makes the graph of so many sweeps: tasks sweep * tasks_of_sweep() + set, the last of
  // a sweep being its end.
  void cut(const PreparedStep& step, int sweeps);

  int count() const { return count_; }
  std::span<const int> of_body() const { return slab_of_body_; }
  // Sets of groups: insides 0 .. count() - 1, then gaps behind even slabs, then those behind odd ones.
  int set_count() const { return 2 * count_ - 1; }
  int tasks_of_sweep() const { return set_count() + 1; }
  int set_of(const RowGroup& group) const;
  const TaskGraph& graph() const { return graph_; }

 private:
  void measure_distances(const PreparedStep& step);
  int walk_from(const PreparedStep& step, int start, int distance);
  void cut_at_distances(const PreparedStep& step);
  int set_of_gap(int gap) const;
  void build_graph(int sweeps);
  void wait_for_neighbours(int begin, int gap);

  int count_ = 0;
  int graph_count_ = 0, graph_sweeps_ = 0;  // slabs and sweeps of the graph
  std::vector<int> slab_of_body_;
  TaskGraph graph_;
  // Scratch.
  std::vector<int> distance_, queue_, rows_at_;
  std::vector<std::pair<int, int>> waits_;
  std::vector<double> places_;
};

}  // namespace cleave
