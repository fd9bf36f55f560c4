#include "solver/background_task.h"

namespace cleave {

bool BackgroundPlace::offer(BackgroundTask& task) {
  task.failure = nullptr;
  task.is_done = false;
  BackgroundTask* nobodys = nullptr;
  return task_.compare_exchange_strong(nobodys, &task);
}

// Nothing of it is touched once it is said to be done: it may be gone.
bool BackgroundPlace::run() {
  BackgroundTask* task = is_empty() ? nullptr : task_.exchange(nullptr);
  if (task == nullptr) return false;
  try {
    task->work();
  } catch (...) {
    task->failure = std::current_exception();
  }
  task->is_done = true;
  return true;
}

bool BackgroundPlace::withdraw(BackgroundTask& task) {
  BackgroundTask* own = &task;
  return !task.is_offered || task_.compare_exchange_strong(own, nullptr);
}

}  // namespace cleave
