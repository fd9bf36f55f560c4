// What the threads of this process get of the cores while something runs: read before and after, never inside
// what is timed.
#pragma once

namespace cleave {

struct CoreTimes {
  double cpu_ms;         // of all threads
  double waiting_ms;     // ready to run, but no core was free; NaN where the kernel keeps no schedstat
  double round_trip_ns;  // of a number between two threads, just before (solver/core_round_trip.h)
};

class CoreMeter {
 public:
  explicit CoreMeter(int threads);  // of what runs; begins
  CoreTimes stop() const;           // since then

 private:
  double round_trip_ns_, waiting_ms_, cpu_ms_;
};

// Largest resident set of the process so far, 1e6 bytes; NaN where the system does not say.
double peak_memory_mb();

}  // namespace cleave
