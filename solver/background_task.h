// Work that goes on beside the stages of a solve, and the place where one thread leaves it for another.
#pragma once

#include <atomic>
#include <exception>
#include <functional>

namespace cleave {

// Belongs to its caller, who finishes or cancels it.
struct BackgroundTask {
  std::function<void()> work;  // empty: none; runs no stage of its own
  // The team's.
  bool is_offered = false;  // to others than its caller
  std::exception_ptr failure;
  std::atomic<bool> is_done{false};
};

class BackgroundPlace {
 public:
  bool is_empty() const { return task_.load() == nullptr; }
  // False where another caller's task stands there still.
  bool offer(BackgroundTask& task);
  // Does the task that stands there; false where there is none.
  bool run();
  // True where nobody has begun it, nor will; else it is done, or will be. Of one that is not offered: true.
  bool withdraw(BackgroundTask& task);

 private:
  std::atomic<BackgroundTask*> task_{nullptr};
};

}  // namespace cleave
