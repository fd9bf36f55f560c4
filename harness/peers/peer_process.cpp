#include "harness/peers/peer_process.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <omp.h>
#include <poll.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <new>

#include "harness/base/end_with_parent.h"
#include "harness/base/numbers.h"
#include "harness/files/write_all.h"

namespace cleave {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kLookForStopEvery_ms = 50;
constexpr char kAnswer = 'a', kError = 'e', kNoMemory = 'm';

// Plain data at the head of an answer; message and impulses follow.
struct Head {
  bool claims_success;
  int iterations;
  double solve_ms;
  std::size_t message_bytes, impulses;
};

std::string packed(const PeerAnswer& answer) {
  const Head head{answer.claims_success, answer.iterations, answer.solve_ms, answer.message.size(),
                  answer.impulse.size()};
  std::string bytes(reinterpret_cast<const char*>(&head), sizeof head);
  bytes += answer.message;
  return bytes.append(reinterpret_cast<const char*>(answer.impulse.data()),
                      answer.impulse.size() * sizeof(double));
}

// False where bytes are missing.
bool unpack(const std::string& bytes, PeerAnswer& answer) {
  Head head{};
  if (bytes.size() < sizeof head) return false;
  ::memcpy(&head, bytes.data(), sizeof head);
  if (bytes.size() != sizeof head + head.message_bytes + head.impulses * sizeof(double)) return false;
  answer = {head.claims_success, bytes.substr(sizeof head, head.message_bytes), head.iterations,
            head.solve_ms, std::vector<double>(head.impulses)};
  ::memcpy(answer.impulse.data(), bytes.data() + sizeof head + head.message_bytes,
           head.impulses * sizeof(double));
  return true;
}

// A child has the calling thread alone: libraries must not look for others. Its crash is expected and leaves no core.
void enter_child(pid_t parent) {
  end_with_parent(parent);
  ::signal(SIGINT, SIG_IGN);  // the parent says when
  ::signal(SIGPIPE, SIG_DFL);
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) ::signal(signal, SIG_DFL);
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  for (const int printed : {STDOUT_FILENO, STDERR_FILENO}) ::dup2(nowhere, printed);
  omp_set_num_threads(1);
  // Of whatever BLAS a library has brought along.
  if (void* const set_threads = ::dlsym(RTLD_DEFAULT, "openblas_set_num_threads"))
    reinterpret_cast<void (*)(int)>(set_threads)(1);
}

[[noreturn]] void serve(int pipe, const std::function<PeerAnswer()>& work) {
  char kind = kAnswer;
  std::string bytes;
  try {
    bytes = packed(work());
  } catch (const std::bad_alloc&) {
    kind = kNoMemory;
  } catch (const std::exception& error) {
    kind = kError;
    bytes = error.what();
  }
  const bool sent = write_all(pipe, {&kind, 1}) && write_all(pipe, bytes);
  ::_exit(sent ? 0 : 1);
}

// A child and the pipe from it. What is left of them goes with the object.
class Child {
 public:
  explicit Child(const std::function<PeerAnswer()>& work) {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) throw std::bad_alloc();
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
    ::close(pipe_);
    throw std::bad_alloc();
  }
  ~Child() {
    ::close(pipe_);
    if (pid_ <= 0) return;
    ::kill(pid_, SIGKILL);
    wait();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  // All that it sends until it ends; false where the deadline came first.
  bool receive(Clock::time_point deadline, const std::atomic<bool>* stop, std::string& bytes) {
    char block[1 << 16];
    for (;;) {
      check_stop(stop);
      if (Clock::now() >= deadline) return false;
      pollfd ready{pipe_, POLLIN, 0};
      if (::poll(&ready, 1, kLookForStopEvery_ms) <= 0) continue;
      const ssize_t count = ::read(pipe_, block, sizeof block);
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return true;
      bytes.append(block, static_cast<std::size_t>(count));
    }
  }

  // How it ended.
  int wait() {
    int status = 0;
    while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    pid_ = -1;
    return status;
  }

 private:
  pid_t pid_ = -1;
  int pipe_ = -1;
};

std::string signal_text(int status) {
  const char* name = WIFSIGNALED(status) ? ::sigabbrev_np(WTERMSIG(status)) : nullptr;
  if (name != nullptr) return std::string("the library ended its process (SIG") + name + ")";
  return "the library ended its process with code " + std::to_string(WEXITSTATUS(status));
}

}  // namespace

PeerEnd run_peer(const std::function<PeerAnswer()>& work, double timeout_s, const std::atomic<bool>* stop) {
  const std::chrono::duration<double> most(std::min(timeout_s, 1e9));
  const Clock::time_point deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(most);
  Child child(work);
  std::string bytes;
  PeerEnd end;
  if (!child.receive(deadline, stop, bytes)) {
    end.status = SolveStatus::timeout;
    end.message = "ended after " + number_text(timeout_s) + " s";
    return end;
  }
  const int status = child.wait();
  const char kind = bytes.empty() ? kError : bytes.front();
  const std::string rest = bytes.empty() ? "" : bytes.substr(1);
  if (kind == kAnswer && unpack(rest, end.answer)) return end;
  if (kind == kNoMemory) {
    end.status = SolveStatus::out_of_memory;
    end.message = "no memory left";
  } else {
    end.status = SolveStatus::crashed;
    end.message = kind == kError && !rest.empty() ? rest : signal_text(status);
  }
  return end;
}

}  // namespace cleave
