// A copy of this process for work that may crash, hang or take all memory: the child alone meets that, and
// sends back plain bytes, which the caller checks.
#pragma once

#include <sys/types.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <string>

namespace cleave {

class ForkedChild {
 public:
  using Clock = std::chrono::steady_clock;

  // kind: what the bytes are, as the caller has it.
  struct Message {
    char kind = 0;
    std::string bytes;
  };

  // work runs in the child, which has the calling thread alone, and must not throw. Its crashes leave no core
  // and run no handler of the parent's, what it prints is lost, and it does not outlive the parent. Throws
  // std::system_error where the system makes no process.
  explicit ForkedChild(const std::function<Message()>& work);
  ~ForkedChild();  // ends it where it still works
  ForkedChild(const ForkedChild&) = delete;
  ForkedChild& operator=(const ForkedChild&) = delete;

  // Waits for what it sends; kind 0 where it ended without. False where the deadline came first. Throws
  // Stopped where stop comes true.
  bool receive(Message& message, Clock::time_point deadline = Clock::time_point::max(),
               const std::atomic<bool>* stop = nullptr);

  // How it ended, as waitpid says it.
  int wait();

 private:
  pid_t pid_ = -1;
  int pipe_ = -1;
};

}  // namespace cleave
