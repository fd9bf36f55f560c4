#include "tests/fuzz/child_reports.h"

#include <pthread.h>
#include <sys/mman.h>
#include <unistd.h>

#include <filesystem>
#include <sstream>

// Of the sanitisers' runtime.
extern "C" __attribute__((weak)) void __sanitizer_set_report_fd(void* file);

namespace cleave::fuzz {
namespace {

int report_file() {
  static const int file = ::memfd_create("reports", MFD_CLOEXEC);
  return file;
}

void redirect_reports() {
  if (__sanitizer_set_report_fd != nullptr)
    __sanitizer_set_report_fd(reinterpret_cast<void*>(static_cast<std::intptr_t>(report_file())));
}

[[maybe_unused]] const int kRedirected =
    (report_file(), ::pthread_atfork(nullptr, nullptr, redirect_reports));

std::string program_path() {
  static const std::string path = std::filesystem::read_symlink("/proc/self/exe");
  return path;
}

bool is_of_program(const std::string& frame) {
  return frame.find("(" + program_path() + "+0x") != std::string::npos;
}

}  // namespace

std::string take_child_report() {
  const off_t size = ::lseek(report_file(), 0, SEEK_END);
  if (size <= 0) return "";
  std::string report(static_cast<std::size_t>(size), '\0');
  if (::pread(report_file(), report.data(), report.size(), 0) != size || ::ftruncate(report_file(), 0) != 0)
    return report;
  ::lseek(report_file(), 0, SEEK_SET);
  return report;
}

// A stack is lines "    #0 0x0123 (module+0x4567)"; the first one is where it happened, others tell whose memory it was.
bool is_own_fault(const std::string& report) {
  std::istringstream lines(report);
  bool is_first_stack = true, innermost_is_own = false;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t frame = line.find_first_not_of(' ');
    if (frame == std::string::npos || line[frame] != '#') continue;
    const bool is_own = is_of_program(line);
    if (line.compare(frame, 3, "#0 ") == 0) innermost_is_own = is_own;
    if (line.compare(frame, 3, "#1 ") != 0) continue;
    if (is_own && (innermost_is_own || !is_first_stack)) return true;
    is_first_stack = false;
  }
  return report.find("runtime error:") != std::string::npos;
}

}  // namespace cleave::fuzz
