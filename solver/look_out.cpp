#include "solver/look_out.h"

#include <sys/resource.h>

#include <charconv>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

namespace cleave {
namespace {

using Clock = std::chrono::steady_clock;

// A thread that was pushed off its core within this time takes the machine for busy.
constexpr std::chrono::milliseconds kBusyFor{100};

}  // namespace

bool was_pushed_off_lately() {
  thread_local long switches = 0;
  thread_local Clock::time_point busy_until{};
  rusage usage{};
  ::getrusage(RUSAGE_THREAD, &usage);
  const auto now = Clock::now();
  if (std::exchange(switches, usage.ru_nivcsw) != usage.ru_nivcsw) busy_until = now + kBusyFor;
  return now < busy_until;
}

const std::optional<Clock::duration>& asked_look_out() {
  static const std::optional<Clock::duration> asked = []() -> std::optional<Clock::duration> {
    const char* text = std::getenv("CLEAVE_LOOK_OUT_US");
    if (text == nullptr) return std::nullopt;
    int microseconds = -1;
    const char* end = text + std::strlen(text);
    const auto [last, error] = std::from_chars(text, end, microseconds);
    if (error != std::errc{} || last != end || microseconds < 0)
      throw std::invalid_argument("CLEAVE_LOOK_OUT_US: '" + std::string(text) +
                                  "' is not a whole number of microseconds in [0, 2147483647]");
    return std::chrono::microseconds(microseconds);
  }();
  return asked;
}

}  // namespace cleave
