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

// As many are made by somebody who says so.
void check_threads(int count) {
  std::atomic<bool> all_made{false};
  std::vector<std::thread> threads;
  threads.reserve(count);
  std::string refusal;
  try {
    while (static_cast<int>(threads.size()) < count)
      threads.emplace_back([&all_made] { all_made.wait(false); });
  } catch (const std::system_error& error) {
    refusal = "the system makes " + std::to_string(threads.size()) + " of " + std::to_string(count) +
              " threads: " + error.what();
  }
  all_made = true;
  all_made.notify_all();
  for (std::thread& thread : threads) thread.join();
  if (!refusal.empty()) throw std::runtime_error(refusal);
}

void load_unwinder() {
  void* caller = nullptr;
  if (::backtrace(&caller, 1) == 0) throw std::bad_alloc();
}

}  // namespace cleave
