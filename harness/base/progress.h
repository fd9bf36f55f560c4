// The progress line on the terminal. Rewritten in place about once a second on a terminal, else a line of its
// own about every ten seconds. Silent for work that is over sooner.
#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace cleave {

class ProgressLine {
 public:
  explicit ProgressLine(std::string label);
  ~ProgressLine();  // leaves the cursor at the start of a fresh line
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  // Steps done, elapsed and expected time, which expected_seconds reads again.
  void update(long long done, long long total);
  // For other work: whether it is time for a line, and the line behind the label. On a terminal it is cut to
  // what fits beside the cursor, as a line that wraps cannot be rewritten.
  bool is_due() const;
  void show(const std::string& text);

 private:
  using Clock = std::chrono::steady_clock;
  std::string label_;
  bool terminal_;
  bool shown_ = false;
  std::size_t width_ = 0;  // characters of the text that stands on the terminal
  Clock::time_point begin_ = Clock::now();
  Clock::time_point last_ = begin_;
};

// Of work as a whole, as the last line of update() in what it printed tells; nothing where there is none.
std::optional<double> expected_seconds(const std::string& printed);

}  // namespace cleave
