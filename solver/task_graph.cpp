#include "solver/task_graph.h"

#include <algorithm>
#include <cassert>

namespace cleave {

void TaskGraph::build(int task_count, std::span<const std::pair<int, int>> waits,
                      std::span<const double> places) {
  assert(places.empty() || static_cast<int>(places.size()) == task_count);
  places_.assign(places.begin(), places.end());
  wait_count_.assign(task_count, 0);
  next_first_.assign(task_count + 1, 0);
  next_.resize(waits.size());
  for (const auto& [earlier, later] : waits) {
    assert(0 <= earlier && earlier < later && later < task_count);
    ++wait_count_[later];
    ++next_first_[earlier];
  }
  for (int task = 0, begin = 0; task <= task_count; ++task) begin += std::exchange(next_first_[task], begin);
  for (const auto& [earlier, later] : waits) next_[next_first_[earlier]++] = later;
  for (int task = task_count; task > 0; --task) next_first_[task] = next_first_[task - 1];
  next_first_[0] = 0;
  for (int task = 0; task < task_count; ++task) {
    std::sort(next_.begin() + next_first_[task], next_.begin() + next_first_[task + 1]);
  }
}

}  // namespace cleave
