#include "solver/thread_making.h"

#include <execinfo.h>

#include <atomic>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

namespace cleave {

namespace {

// Threads that wait for its end, which joins them however it comes.
class WaitingThreads {
 public:
  explicit WaitingThreads(int count) { threads_.reserve(count); }
  ~WaitingThreads() {
    ends_ = true;
    ends_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }
  void add() {
    threads_.emplace_back([this] { ends_.wait(false); });
  }
  int count() const { return static_cast<int>(threads_.size()); }

 private:
  std::atomic<bool> ends_{false};
  std::vector<std::thread> threads_;
};

}  // namespace

// As many are made by somebody who says so.
void check_threads(int count) {
  WaitingThreads threads(count);
  try {
    while (threads.count() < count) threads.add();
  } catch (const std::system_error& error) {
    throw std::runtime_error("the system makes " + std::to_string(threads.count()) + " of " +
                             std::to_string(count) + " threads: " + error.what());
  }
}

void load_unwinder() {
  void* caller = nullptr;
  if (::backtrace(&caller, 1) == 0) throw std::bad_alloc();
}

}  // namespace cleave
