#include "harness/files/isolated_read.h"

#include <fcntl.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "harness/base/room.h"
#include "harness/files/write_all.h"

namespace cleave {
namespace {

// The first byte that a child sends says what follows.
constexpr char kValue = 'v', kError = 'e', kErrorWithoutMemory = 'm';
constexpr int kChildFailed = 1;
// With less than this part of what a child may use left, a library's error may be that it found no memory.
constexpr std::size_t kPartOfRoom = 8;

[[noreturn]] void fail(const std::string& subject, const std::string& text) {
  throw std::invalid_argument(subject + ": " + text);
}

void set_limit(int resource, rlim_t most) {
  rlimit limit{};
  ::getrlimit(resource, &limit);
  limit.rlim_cur = std::min(limit.rlim_max, std::min(limit.rlim_cur, most));
  ::setrlimit(resource, &limit);
}

// How much address space may be used at all, where little is allowed (ulimit -v); else 0.
std::size_t allowed_address_space_bytes() {
  rlimit limit{};
  ::getrlimit(RLIMIT_AS, &limit);
  return limit.rlim_cur == RLIM_INFINITY ? 0 : limit.rlim_cur;
}

std::size_t address_space_bytes() {
  unsigned long pages = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(file, "%lu", &pages) != 1) pages = 0;
    std::fclose(file);
  }
  return pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

// Crashes are what the child is for: they leave no core, run no handler of the parent's and print nothing. Interrupts are
// taken as the parent takes them: where they end a run after the step at hand, its file is still read.
void enter_child(const ReadLimits& limits) {
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU, SIGPIPE})
    ::signal(signal, SIG_DFL);
  set_limit(RLIMIT_CORE, 0);
  set_limit(RLIMIT_CPU, static_cast<rlim_t>(limits.processor_s));
  if (const std::size_t used = address_space_bytes(); used > 0)
    set_limit(RLIMIT_AS, used + limits.memory_bytes);
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  for (const int printed : {STDOUT_FILENO, STDERR_FILENO}) ::dup2(nowhere, printed);
}

// What is sent ends the child: no exit handler of the parent runs in it.
[[noreturn]] void serve(int pipe, const ReadLimits& limits, const std::function<std::string()>& read) {
  char kind = kValue;
  std::string bytes;
  try {
    bytes = read();
  } catch (const std::exception& error) {
    kind = has_room(limits.memory_bytes / kPartOfRoom) ? kError : kErrorWithoutMemory;
    bytes = error.what();
  }
  const bool sent = write_all(pipe, {&kind, 1}) && write_all(pipe, bytes);
  ::_exit(sent ? 0 : kChildFailed);
}

std::string receive(int pipe) {
  std::string bytes;
  char block[1 << 16];
  for (;;) {
    const ssize_t count = ::read(pipe, block, sizeof block);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return bytes;
    bytes.append(block, static_cast<std::size_t>(count));
  }
}

int wait_for(pid_t child) {
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

// Whether less is allowed (ulimit -v) than a child may use.
bool is_short_of_memory(const ReadLimits& limits) {
  const std::size_t allowed = allowed_address_space_bytes();
  return allowed != 0 && allowed < address_space_bytes() + limits.memory_bytes;
}

std::string allowed_memory_text() {
  return std::to_string(allowed_address_space_bytes() / 1024) + " kB of memory allowed";
}

void check_end(const std::string& subject, const ReadLimits& limits, int status) {
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  if (signal == SIGXCPU)
    fail(subject, "damaged: the HDF5 library had not read it after " + std::to_string(limits.processor_s) +
                      " s of processor time");
  const char* name = signal == 0 ? nullptr : ::sigabbrev_np(signal);
  const std::string crash = std::string("the HDF5 library crashed while reading it") +
                            (name == nullptr ? "" : std::string(" (SIG") + name + ")");
  // The library crashes where it finds no memory too.
  if (is_short_of_memory(limits))
    fail(subject, "cannot be read with " + allowed_memory_text() + ": " + crash);
  fail(subject, "damaged: " + crash);
}

}  // namespace

ReadLimits read_limits(const std::filesystem::path& path) {
  std::error_code error;
  const std::uintmax_t size =
      std::filesystem::is_regular_file(path, error) ? std::filesystem::file_size(path, error) : 0;
  constexpr std::size_t kMegabyte = 1 << 20;
  return {256 * kMegabyte + 64 * size, static_cast<int>(5 + size / kMegabyte)};
}

std::string read_in_child(const std::string& subject, const ReadLimits& limits,
                          const std::function<std::string()>& read) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) fail(subject, std::string("cannot be read: pipe: ") + ::strerror(errno));
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(ends[0]);
    enter_child(limits);
    serve(ends[1], limits, read);
  }
  const int reason = errno;
  ::close(ends[1]);
  std::string bytes;
  if (child > 0) bytes = receive(ends[0]);
  ::close(ends[0]);
  if (child < 0) fail(subject, std::string("cannot be read: fork: ") + ::strerror(reason));
  check_end(subject, limits, wait_for(child));
  if (bytes.empty()) fail(subject, "damaged: the HDF5 library ended the reading of it");
  const char kind = bytes.front();
  bytes.erase(0, 1);
  if (kind == kErrorWithoutMemory && is_short_of_memory(limits))
    fail(subject, "cannot be read with " + allowed_memory_text());
  if (kind != kValue) throw std::invalid_argument(bytes);
  return bytes;
}

void forbid_opening_files() { set_limit(RLIMIT_NOFILE, 0); }

}  // namespace cleave
