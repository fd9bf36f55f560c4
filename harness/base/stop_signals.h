// The signals that ask the program to stop.
#pragma once

#include <signal.h>

namespace cleave {

// From the keyboard, from another program, and from a terminal that is closed.
inline constexpr int kStopSignals[] = {SIGINT, SIGTERM, SIGHUP};

// Whether the program listens to one of them: not to a hang-up under nohup.
inline bool is_listened_to(int signal) {
  struct sigaction now {};
  ::sigaction(signal, nullptr, &now);
  return signal != SIGHUP || now.sa_handler != SIG_IGN;
}

}  // namespace cleave
