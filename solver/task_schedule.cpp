#include "solver/task_schedule.h"

#include <algorithm>
#include <bit>
#include <functional>
#include <numeric>

namespace cleave {
namespace {

constexpr int kSomethingElse = -1;  // in the place of a task

// As pairs compare, without their three ways.
bool ends_later(const std::pair<double, int>& a, const std::pair<double, int>& b) {
  return a.first > b.first || (a.first == b.first && a.second > b.second);
}

}  // namespace

double makespan_ms(std::span<const double> sorted_descending_ms, int workers, std::vector<double>& worker_ms,
                   double busy_ms) {
  worker_ms.assign(workers, 0.0);
  worker_ms.back() = busy_ms;
  double end_ms = 0;
  for (const double task : sorted_descending_ms)
    end_ms = std::max(end_ms, *std::min_element(worker_ms.begin(), worker_ms.end()) += task);
  return end_ms;
}

void GraphSchedule::begin(const TaskGraph& graph, std::span<const double> task_ms) {
  graph_ = &graph;
  task_ms_ = task_ms;
  way_ms_.assign(task_ms.begin(), task_ms.end());
  longest_ms_ = 0;
  for (int task = graph.task_count() - 1; task >= 0; --task) {
    double after_ms = 0;
    for (const int next : graph.next(task)) after_ms = std::max(after_ms, way_ms_[next]);
    way_ms_[task] += after_ms;
    longest_ms_ = std::max(longest_ms_, way_ms_[task]);
  }
  task_of_rank_.resize(graph.task_count());
  std::iota(task_of_rank_.begin(), task_of_rank_.end(), 0);
  std::ranges::sort(task_of_rank_, {}, [&](int task) { return std::pair(-way_ms_[task], task); });
  rank_of_task_.resize(graph.task_count());
  for (int rank = 0; rank < graph.task_count(); ++rank) rank_of_task_[task_of_rank_[rank]] = rank;
  running_.reserve(graph.task_count() + 1);  // how many there are at once depends on the times
}

void GraphSchedule::add_ready(int task) {
  const auto rank = static_cast<std::size_t>(rank_of_task_[task]);
  ready_[rank / 64] |= std::uint64_t{1} << (rank % 64);
  first_word_ = std::min(first_word_, rank / 64);
  ++ready_count_;
}

int GraphSchedule::take_ready() {
  while (ready_[first_word_] == 0) ++first_word_;
  const int bit = std::countr_zero(ready_[first_word_]);
  ready_[first_word_] &= ready_[first_word_] - 1;
  --ready_count_;
  return task_of_rank_[64 * first_word_ + bit];
}

double GraphSchedule::makespan_ms(int workers, double busy_ms) {
  const int count = graph_->task_count();
  ready_.assign((count + 63) / 64, 0);
  ready_count_ = 0;
  running_.clear();
  waits_.resize(count);
  for (int task = 0; task < count; ++task) {
    waits_[task] = graph_->wait_count(task);
    if (waits_[task] == 0) add_ready(task);
  }
  double now_ms = 0;
  if (busy_ms > 0) running_.emplace_back(busy_ms, kSomethingElse);
  for (int left = count; left > 0;) {
    while (ready_count_ > 0 && static_cast<int>(running_.size()) < workers) {
      const int task = take_ready();
      running_.emplace_back(now_ms + task_ms_[task], task);
      std::ranges::push_heap(running_, ends_later);
    }
    std::ranges::pop_heap(running_, ends_later);
    const auto [end_ms, task] = running_.back();
    running_.pop_back();
    now_ms = end_ms;
    if (task == kSomethingElse) continue;
    --left;
    for (const int next : graph_->next(task)) {
      if (--waits_[next] == 0) add_ready(next);
    }
  }
  return now_ms;
}

}  // namespace cleave
