// The progress line on the terminal: steps done, elapsed and expected time. Rewritten in place about once a
// second on a terminal, else a line of its own about every ten seconds. Silent for runs that are over sooner.
#pragma once

#include <chrono>
#include <string>

namespace cleave {

class ProgressLine {
 public:
  explicit ProgressLine(std::string label);
  ~ProgressLine();  // leaves the cursor at the start of a fresh line
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void update(int done, int total);

 private:
  using Clock = std::chrono::steady_clock;
  std::string label_;
  bool terminal_;
  bool shown_ = false;
  Clock::time_point begin_ = Clock::now();
  Clock::time_point last_ = begin_;
};

}  // namespace cleave
