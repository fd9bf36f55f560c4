#include "harness/peers/peer_process.h"

#include <dlfcn.h>
#include <omp.h>
#include <string.h>
#include <sys/wait.h>

#include <chrono>
#include <csignal>
#include <memory>
#include <new>
#include <system_error>

#include "harness/base/forked_child.h"
#include "harness/base/numbers.h"
#include "harness/base/signal_name.h"

namespace cleave {
namespace {

using Clock = ForkedChild::Clock;

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

// In the child, which has the calling thread alone: libraries must not look for others.
void enter_child() {
  ::signal(SIGINT, SIG_IGN);  // the parent says when
  omp_set_num_threads(1);
  // Of whatever BLAS a library has brought along.
  if (void* const set_threads = ::dlsym(RTLD_DEFAULT, "openblas_set_num_threads"))
    reinterpret_cast<void (*)(int)>(set_threads)(1);
}

ForkedChild::Message serve(const std::function<PeerAnswer()>& work) {
  enter_child();
  try {
    return {kAnswer, packed(work())};
  } catch (const std::bad_alloc&) {
    return {kNoMemory, {}};
  } catch (const std::exception& error) {
    return {kError, error.what()};
  }
}

std::string end_text(int status) {
  return "the library ended its process " + (WIFSIGNALED(status)
                                                 ? "(" + signal_name(WTERMSIG(status)) + ")"
                                                 : "with code " + std::to_string(WEXITSTATUS(status)));
}

std::unique_ptr<ForkedChild> make_child(const std::function<PeerAnswer()>& work) {
  try {
    return std::make_unique<ForkedChild>([&] { return serve(work); });
  } catch (const std::system_error&) {
    throw std::bad_alloc();
  }
}

}  // namespace

PeerEnd run_peer(const std::function<PeerAnswer()>& work, double timeout_s, const std::atomic<bool>* stop) {
  const std::chrono::duration<double> most(std::min(timeout_s, 1e9));
  const Clock::time_point deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(most);
  const std::unique_ptr<ForkedChild> child = make_child(work);
  ForkedChild::Message message;
  PeerEnd end;
  if (!child->receive(message, deadline, stop)) {
    end.status = SolveStatus::timeout;
    end.message = "ended after " + number_text(timeout_s) + " s";
    return end;
  }
  const int status = child->wait();
  if (message.kind == kAnswer && unpack(message.bytes, end.answer)) return end;
  if (message.kind == kNoMemory) {
    end.status = SolveStatus::out_of_memory;
    end.message = "no memory left";
  } else {
    end.status = SolveStatus::crashed;
    end.message = message.kind == kError && !message.bytes.empty() ? message.bytes : end_text(status);
  }
  return end;
}

}  // namespace cleave
