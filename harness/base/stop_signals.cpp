#include "harness/base/stop_signals.h"

namespace cleave {
namespace {

std::atomic<bool> stop{false};
static_assert(std::atomic<bool>::is_always_lock_free);

// The next one ends the program as if nothing had been set, unless it is a hang-up: a terminal that is closed
// may send two.
void take_stop(int) {
  stop = true;
  for (const int signal : kStopSignals) ::signal(signal, signal == SIGHUP ? SIG_IGN : SIG_DFL);
}

}  // namespace

void stop_on_signals() {
  struct sigaction action {};
  action.sa_handler = take_stop;
  action.sa_flags = SA_RESTART;
  for (const int signal : kStopSignals) ::sigaddset(&action.sa_mask, signal);  // one handler after the other
  for (const int signal : kStopSignals)
    if (is_listened_to(signal)) ::sigaction(signal, &action, nullptr);
}

const std::atomic<bool>& stop_requested() { return stop; }

}  // namespace cleave
