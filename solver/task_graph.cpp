#include "solver/task_graph.h"

#include <algorithm>
#include <cassert>

#include "solver/counting_sort.h"

namespace cleave {

void TaskGraph::build(int task_count, std::span<const std::pair<int, int>> waits,
                      std::span<const double> places) {
  assert(places.empty() || static_cast<int>(places.size()) == task_count);
  places_.assign(places.begin(), places.end());
  wait_count_.assign(task_count, 0);
  for (const auto& [earlier, later] : waits) {
    assert(0 <= earlier && earlier < later && later < task_count);
    ++wait_count_[later];
  }
  sort_into_buckets(
      static_cast<int>(waits.size()), task_count, [&](int wait) { return waits[wait].first; }, next_first_,
      next_);
  for (int& next : next_) next = waits[next].second;
  for (int task = 0; task < task_count; ++task) {
    std::sort(next_.begin() + next_first_[task], next_.begin() + next_first_[task + 1]);
  }
}

}  // namespace cleave
