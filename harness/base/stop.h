// How a solve that is under way is asked to end.
#pragma once

#include <atomic>
#include <exception>

namespace cleave {

// Out of a solve whose caller asked it to end. The solver may be asked to solve again.
class SolveStopped : public std::exception {
 public:
  const char* what() const noexcept override { return "stopped while solving"; }
};

inline void check_stop(const std::atomic<bool>* stop) {
  if (stop != nullptr && stop->load(std::memory_order_relaxed)) throw SolveStopped();
}

}  // namespace cleave
