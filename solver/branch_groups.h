// Branches of an elimination tree (block_symbolic.h) joined into tasks of a substitution.
//
// Branches are cut for the factorisation, whose work grows with the square of what a substitution takes:
// there, handing a branch to a thread would take as long as its work. A branch with little of it, counted
// with what joined it from below, is joined to its parent. So tasks are subtrees, or chains at the top, and
// what they add up to is as before, in the same order. On one thread every branch is a task: their times are
// what is scheduled on workers that are not there.
#pragma once

#include <span>
#include <vector>

#include "solver/block_symbolic.h"
#include "solver/task_graph.h"

namespace cleave {

class BranchGroups {
 public:
  // Groups are numbered so that each comes before the one that its parent is in. Buffers are kept.
  void join(const BlockSymbolic& symbolic, int threads);
  int group_count() const { return static_cast<int>(parent_.size()); }
  // Ascending: children first.
  std::span<const int> branches(int group) const {
    return std::span(branches_).subspan(first_[group], first_[group + 1] - first_[group]);
  }
  // Forward through group g is task g, backward task 2 group_count() - 1 - g.
  const TaskGraph& graph() const { return graph_; }
  void count(MemoryCount& memory) const;

 private:
  bool joins(const Branch& branch, int index) const;
  void number(std::span<const Branch> branches);
  void list_tasks(const BlockSymbolic& symbolic);

  std::vector<int> parent_;  // by group, -1 for one with a root of the tree
  std::vector<int> first_, branches_;
  TaskGraph graph_;
  double least_ = 0;                        // work of a task
  std::vector<double> work_;                // scratch: by branch, with what joined it
  std::vector<int> group_;                  // scratch: by branch
  std::vector<std::pair<int, int>> waits_;  // scratch
  std::vector<double> places_;              // scratch
};

}  // namespace cleave
