#include "harness/files/isolated_read.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "harness/base/forked_child.h"
#include "harness/base/room.h"
#include "harness/base/signal_name.h"

namespace cleave {
namespace {

// The first byte that a child sends says what follows.
constexpr char kValue = 'v', kError = 'e', kErrorWithoutMemory = 'm';
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

// In the child. Interrupts are taken as the parent takes them: where they end a run after the step at hand,
// its file is still read.
void set_limits(const ReadLimits& limits) {
  set_limit(RLIMIT_CPU, static_cast<rlim_t>(limits.processor_s));
  if (const std::size_t used = address_space_bytes(); used > 0)
    set_limit(RLIMIT_AS, used + limits.memory_bytes);
}

ForkedChild::Message serve(const ReadLimits& limits, const std::function<std::string()>& read) {
  set_limits(limits);
  try {
    return {kValue, read()};
  } catch (const std::exception& error) {
    return {has_room(limits.memory_bytes / kPartOfRoom) ? kError : kErrorWithoutMemory, error.what()};
  }
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
  const std::string crash = std::string("the HDF5 library crashed while reading it") +
                            (signal == 0 ? "" : " (" + signal_name(signal) + ")");
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
  ForkedChild::Message message;
  int status = 0;
  try {
    ForkedChild child([&] { return serve(limits, read); });
    child.receive(message);
    status = child.wait();
  } catch (const std::system_error& error) {
    fail(subject, std::string("cannot be read: ") + error.what());
  }
  check_end(subject, limits, status);
  auto& [kind, bytes] = message;
  if (kind == 0) fail(subject, "damaged: the HDF5 library ended the reading of it");
  if (kind == kErrorWithoutMemory && is_short_of_memory(limits))
    fail(subject, "cannot be read with " + allowed_memory_text());
  if (kind != kValue) throw std::invalid_argument(bytes);
  return bytes;
}

void forbid_opening_files() { set_limit(RLIMIT_NOFILE, 0); }

}  // namespace cleave
