// Laps of a steady clock: the harness times the algorithms, they do not time themselves.
#pragma once

#include <chrono>

namespace cleave {

class Stopwatch {
 public:
  // Milliseconds since construction or the last lap.
  double lap_ms() {
    const Clock::time_point now = Clock::now();
    const double milliseconds = std::chrono::duration<double, std::milli>(now - begin_).count();
    begin_ = now;
    return milliseconds;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point begin_ = Clock::now();
};

}  // namespace cleave
