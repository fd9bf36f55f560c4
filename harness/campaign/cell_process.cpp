#include "harness/campaign/cell_process.h"

#include <fcntl.h>
#include <sched.h>
#include <signal.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <stdexcept>

#include "harness/base/end_with_parent.h"
#include "harness/base/signal_name.h"
#include "harness/base/stop_signals.h"

namespace cleave {
namespace {

constexpr const char* kThisProgram = "/proc/self/exe";  // also where its file has been replaced meanwhile
constexpr off_t kMostPrinted = 1 << 20;

sigset_t waited_for() {
  sigset_t set;
  ::sigemptyset(&set);
  ::sigaddset(&set, SIGCHLD);
  for (const int signal : kStopSignals)
    if (is_listened_to(signal)) ::sigaddset(&set, signal);
  return set;
}

void limit(int resource, rlim_t most) {
  rlimit old{};
  ::getrlimit(static_cast<__rlimit_resource>(resource), &old);
  const rlim_t value = std::min(most, old.rlim_max);
  const rlimit both{value, value};
  ::setrlimit(static_cast<__rlimit_resource>(resource), &both);
}

// Between fork and exec: nothing here allocates.
[[noreturn]] void become(char* const* words, pid_t parent, int printed, double memory_gb,
                         const cpu_set_t* cores) {
  end_with_parent(parent);
  ::setpgid(0, 0);
  const sigset_t set = waited_for();
  ::sigprocmask(SIG_UNBLOCK, &set, nullptr);
  ::signal(SIGPIPE, SIG_DFL);
  limit(RLIMIT_CORE, 0);  // a crash is a row
  if (!std::isnan(memory_gb)) limit(RLIMIT_AS, static_cast<rlim_t>(std::min(memory_gb * 1e9, 9e18)));
  if (cores != nullptr) ::sched_setaffinity(0, sizeof *cores, cores);
  const int nothing = ::open("/dev/null", O_RDONLY);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(printed, STDOUT_FILENO);
  ::dup2(printed, STDERR_FILENO);
  ::execv(kThisProgram, words);
  ::_exit(127);
}

std::string last_of(int file) {
  const off_t size = ::lseek(file, 0, SEEK_END), from = std::max<off_t>(0, size - kMostPrinted);
  std::string text(static_cast<std::size_t>(size - from), '\0');
  const ssize_t count = ::pread(file, text.data(), text.size(), from);
  text.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
  return text;
}

}  // namespace

std::string CellEnd::text() const {
  if (exit_code >= 0) return "ended with exit code " + std::to_string(exit_code);
  return "ended by " + signal_name(signal);
}

std::string CellEnd::last_line() const {
  const std::size_t end = printed.find_last_not_of("\n\r ");
  if (end == std::string::npos) return {};
  const std::size_t before = printed.find_last_of("\n\r", end);
  const std::size_t start = before == std::string::npos ? 0 : before + 1;
  return printed.substr(start, end + 1 - start);
}

CellProcess::CellProcess(const CellCommand& command) {
  std::vector<char*> words;
  for (const std::string& word : command.words) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  cpu_set_t cores;
  CPU_ZERO(&cores);
  for (const int core : command.cores) CPU_SET(static_cast<unsigned>(core), &cores);
  const pid_t self = ::getpid();
  printed_ = ::memfd_create("printed", MFD_CLOEXEC);
  if (printed_ >= 0) pid_ = ::fork();
  if (pid_ == 0)
    become(words.data(), self, printed_, command.memory_gb, command.cores.empty() ? nullptr : &cores);
  if (pid_ > 0) return;
  const int reason = errno;
  if (printed_ >= 0) ::close(printed_);
  throw std::runtime_error(std::string("no process can be made for a cell: ") + ::strerror(reason));
}

CellProcess::~CellProcess() {
  if (!ended_) {
    send(SIGKILL);
    while (::waitpid(pid_, &status_, 0) < 0 && errno == EINTR) continue;
  }
  ::close(printed_);
}

bool CellProcess::has_ended() {
  if (ended_ || ::waitpid(pid_, &status_, WNOHANG) != pid_) return ended_;
  end_ = Clock::now();
  return ended_ = true;
}

CellEnd CellProcess::end() const {
  CellEnd end;
  if (WIFEXITED(status_)) end.exit_code = WEXITSTATUS(status_);
  if (WIFSIGNALED(status_)) end.signal = WTERMSIG(status_);
  end.printed = printed();
  return end;
}

std::string CellProcess::printed() const { return last_of(printed_); }

void CellProcess::send(int signal) const { ::kill(pid_, signal); }

double CellProcess::seconds() const {
  return std::chrono::duration<double>((ended_ ? end_ : Clock::now()) - start_).count();
}

CellEnd run_to_end(const CellCommand& command, bool& interrupted) {
  constexpr double kLookEvery_s = 60;
  const SignalsWaitedFor signals;
  CellProcess process(command);
  while (!process.has_ended()) {
    const int signal = signals.wait(kLookEvery_s);
    if (signal == 0 || signal == SIGCHLD) continue;
    process.send(SIGTERM);
    interrupted = true;
  }
  return process.end();
}

SignalsWaitedFor::SignalsWaitedFor() {
  const sigset_t set = waited_for();
  ::sigprocmask(SIG_BLOCK, &set, nullptr);
}

SignalsWaitedFor::~SignalsWaitedFor() {
  const sigset_t set = waited_for();
  ::sigprocmask(SIG_UNBLOCK, &set, nullptr);
}

int SignalsWaitedFor::wait(double seconds) const {
  const sigset_t set = waited_for();
  const double whole = std::floor(seconds);
  const timespec most{static_cast<time_t>(whole), static_cast<long>((seconds - whole) * 1e9)};
  const int signal = ::sigtimedwait(&set, nullptr, &most);
  return signal > 0 ? signal : 0;
}

}  // namespace cleave
