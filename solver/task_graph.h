// Which tasks of a parallel stage wait for which others, and which belong together.
//
// Tasks are numbered so that each waits for lower numbers only: ascending order is an order to run them in on
// one thread. On several threads a task goes to its home where that thread is free, so that data which tasks
// of one stage after another work on stay in the cache of one core.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "solver/memory_count.h"

namespace cleave {

class TaskGraph {
 public:
  // waits: pairs (earlier task, later task), earlier < later, none twice.
  // places: of each task in [0, 1), what is near goes to one thread; empty: by number.
  void build(int task_count, std::span<const std::pair<int, int>> waits, std::span<const double> places = {});

  int task_count() const { return static_cast<int>(wait_count_.size()); }
  // Number of tasks that this one waits for.
  int wait_count(int task) const { return wait_count_[task]; }
  int home(int task, int threads) const {
    const double place =
        places_.empty() ? static_cast<double>(task) / static_cast<double>(task_count()) : places_[task];
    return static_cast<int>(place * threads);
  }
  // Tasks that wait for this one, ascending.
  std::span<const int> next(int task) const {
    return std::span(next_).subspan(next_first_[task], next_first_[task + 1] - next_first_[task]);
  }
  void count(MemoryCount& memory) const { memory.add_grown(wait_count_, next_first_, next_, places_); }

 private:
  std::vector<int> wait_count_, next_first_, next_;
  std::vector<double> places_;
};

}  // namespace cleave
