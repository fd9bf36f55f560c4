// What has to be seen to before OpenMP makes threads.
#pragma once

#include <signal.h>

#include "harness/base/stop_signals.h"

namespace cleave {

// Throws std::runtime_error where the system does not make so many threads; OpenMP would end the program.
void check_threads(int count);

// Throws std::bad_alloc where there is no memory for the C library's unwinder. OpenMP's threads end by
// pthread_exit, which loads it the first time it needs it and ends the program where it cannot: so it is made
// to need it now.
void load_unwinder();

// While it lives, new threads, and those that they make, start with the signals to stop blocked. A caller
// that blocks these in its own thread, as METIS needs, would otherwise have them delivered to one of the new
// ones.
class SignalsHeldBack {
 public:
  SignalsHeldBack() {
    sigset_t stop;
    ::sigemptyset(&stop);
    for (const int signal : kStopSignals) ::sigaddset(&stop, signal);
    ::pthread_sigmask(SIG_BLOCK, &stop, &before_);
  }
  SignalsHeldBack(const SignalsHeldBack&) = delete;
  SignalsHeldBack& operator=(const SignalsHeldBack&) = delete;
  ~SignalsHeldBack() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

 private:
  sigset_t before_;
};

}  // namespace cleave
