// How work that is under way is asked to end.
#pragma once

#include <atomic>
#include <exception>

namespace cleave {

// Out of a solve or a partitioner whose caller asked it to end. It may be asked to work again.
class Stopped : public std::exception {
 public:
  const char* what() const noexcept override { return "stopped before its end"; }
};

inline void check_stop(const std::atomic<bool>* stop) {
  if (stop != nullptr && stop->load(std::memory_order_relaxed)) throw Stopped();
}

}  // namespace cleave
