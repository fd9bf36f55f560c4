#include "harness/experiment/core_meter.h"

#include <time.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "solver/core_round_trip.h"

namespace cleave {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

double cpu_ms() {
  timespec now{};
  if (::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now) != 0) return kNan;
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

// The second number of every thread's schedstat, ns. A kernel that does not count writes zeros, also for the
// time this thread has run.
double waiting_ms() {
  double run_ns = 0, waiting_ns = 0;
  std::error_code error;
  for (const auto& thread : std::filesystem::directory_iterator("/proc/self/task", error)) {
    double run = 0, waiting = 0;
    std::ifstream(thread.path() / "schedstat") >> run >> waiting;
    run_ns += run;
    waiting_ns += waiting;
  }
  return run_ns > 0 ? 1e-6 * waiting_ns : kNan;
}

}  // namespace

// Reading the files costs processor time, so it stays outside the other clock.
CoreMeter::CoreMeter(int threads)
    : round_trip_ns_(core_round_trip_ns(threads)), waiting_ms_(waiting_ms()), cpu_ms_(cpu_ms()) {}

CoreTimes CoreMeter::stop() const {
  const double cpu = cpu_ms() - cpu_ms_;
  return {cpu, waiting_ms() - waiting_ms_, round_trip_ns_};
}

double peak_memory_mb() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return 1024e-6 * std::stod(line.substr(6));  // in units of 1024 bytes
  return kNan;
}

}  // namespace cleave
