#include "harness/base/forked_child.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <system_error>

#include "harness/base/end_with_parent.h"
#include "harness/base/stop.h"
#include "harness/base/write_all.h"

namespace cleave {
namespace {

constexpr int kLookForStopEvery_ms = 50;

[[noreturn]] void fail(const char* call) { throw std::system_error(errno, std::generic_category(), call); }

void enter_child(pid_t parent) {
  end_with_parent(parent);
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU, SIGPIPE})
    ::signal(signal, SIG_DFL);
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  for (const int printed : {STDOUT_FILENO, STDERR_FILENO}) ::dup2(nowhere, printed);
}

// What is sent ends the child: no exit handler of the parent runs in it.
[[noreturn]] void serve(int pipe, const std::function<ForkedChild::Message()>& work) {
  const ForkedChild::Message message = work();
  const bool sent = write_all(pipe, {&message.kind, 1}) && write_all(pipe, message.bytes);
  ::_exit(sent ? 0 : 1);
}

}  // namespace

ForkedChild::ForkedChild(const std::function<Message()>& work) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) fail("pipe");
  const pid_t self = ::getpid();
  pid_ = ::fork();
  if (pid_ == 0) {
    ::close(ends[0]);
    enter_child(self);
    serve(ends[1], work);
  }
  ::close(ends[1]);
  pipe_ = ends[0];
  if (pid_ > 0) return;
  const int reason = errno;
  ::close(pipe_);
  errno = reason;
  fail("fork");
}

ForkedChild::~ForkedChild() {
  ::close(pipe_);
  if (pid_ <= 0) return;
  ::kill(pid_, SIGKILL);
  wait();
}

bool ForkedChild::receive(Message& message, Clock::time_point deadline, const std::atomic<bool>* stop) {
  message = {};
  char block[1 << 16];
  for (ssize_t count = 1; count != 0;) {
    check_stop(stop);
    if (Clock::now() >= deadline) return false;
    pollfd ready{pipe_, POLLIN, 0};
    if (::poll(&ready, 1, kLookForStopEvery_ms) <= 0) continue;
    count = ::read(pipe_, block, sizeof block);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) break;
    const ssize_t begin = count > 0 && message.kind == 0 ? 1 : 0;
    if (begin == 1) message.kind = block[0];
    message.bytes.append(block + begin, static_cast<std::size_t>(count - begin));
  }
  return true;
}

int ForkedChild::wait() {
  int status = 0;
  while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  return status;
}

}  // namespace cleave
