// How a thread without work waits for some: it looks out for a while, and only then is it worth to sleep.
#pragma once

#include <immintrin.h>

#include <chrono>
#include <optional>

namespace cleave {

// CLEAVE_LOOK_OUT_US in the environment: so many microseconds, whatever the machine does. Throws
// std::invalid_argument where it is no number.
const std::optional<std::chrono::steady_clock::duration>& asked_look_out();

// Whether the machine took this thread off its core a moment ago, and so has other work for it.
bool was_pushed_off_lately();

// Whether `done` came true within the time.
template <class Condition>
bool look_out_for(std::chrono::steady_clock::duration time, Condition done) {
  constexpr int kLooksPerClock = 32;
  const auto end = std::chrono::steady_clock::now() + time;
  do {
    for (int k = 0; k < kLooksPerClock; ++k) {
      if (done()) return true;
      _mm_pause();
    }
  } while (std::chrono::steady_clock::now() < end);
  return false;
}

// Whether `done` came true before it was time to sleep. Waking a thread takes some ten microseconds, so gaps
// shorter than that are best spent awake; on an idle machine longer ones too, because every stage of a solve
// begins with a wake-up otherwise. On a busy machine a long look-out is taken from the thread's own share of
// its core, which it then lacks when there is work.
template <class Condition>
bool look_out(Condition done) {
  constexpr std::chrono::microseconds kLookOut{50}, kLongLookOut{2000};
  if (asked_look_out()) return look_out_for(*asked_look_out(), done);
  return look_out_for(kLookOut, done) || (!was_pushed_off_lately() && look_out_for(kLongLookOut, done));
}

}  // namespace cleave
