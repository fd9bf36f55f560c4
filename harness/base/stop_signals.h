// The signals that ask the program to stop.
#pragma once

#include <signal.h>

#include <atomic>

namespace cleave {

// From the keyboard, from another program, and from a terminal that is closed.
inline constexpr int kStopSignals[] = {SIGINT, SIGTERM, SIGHUP};

// Whether the program listens to one of them: not to a hang-up under nohup.
inline bool is_listened_to(int signal) {
  struct sigaction now {};
  ::sigaction(signal, nullptr, &now);
  return signal != SIGHUP || now.sa_handler != SIG_IGN;
}

// From now on the first of these signals is for the work at hand to see; the second ends the program at once.
void stop_on_signals();

// True once the program was asked to stop, after stop_on_signals().
const std::atomic<bool>& stop_requested();

}  // namespace cleave
