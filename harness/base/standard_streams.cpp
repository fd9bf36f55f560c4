#include "harness/base/standard_streams.h"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>

namespace cleave {

void open_standard_streams() {
  // The lowest number that is free is the one that is given.
  int file = ::open("/dev/null", O_RDWR);
  while (file >= 0 && file <= STDERR_FILENO) file = ::open("/dev/null", O_RDWR);
  if (file >= 0) ::close(file);
  ::signal(SIGPIPE, SIG_IGN);
  ::signal(SIGXFSZ, SIG_IGN);
  // A child of a program that inherited this signal as ignored would end without a trace to wait for.
  ::signal(SIGCHLD, SIG_DFL);
}

OutputState finish_standard_output() {
  errno = 0;
  const bool flushed = std::fflush(stdout) == 0;
  int reason = errno;
  if (flushed && std::ferror(stdout) == 0) return OutputState::whole;
  // Where an earlier write failed its reason is gone; one more byte meets it again.
  if (reason == 0 && ::write(STDOUT_FILENO, "\n", 1) < 0) reason = errno;
  if (reason == EPIPE) return OutputState::reader_gone;
  throw std::runtime_error(std::string("standard output: cannot be written") +
                           (reason == 0 ? "" : std::string(": ") + std::strerror(reason)));
}

}  // namespace cleave
