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

// A stack is lines "    #0 0x0123 (module+0x4567)", with names and places behind where they are known. The
// first one is where it happened, others tell whose memory it was. The innermost frames may be the
// sanitiser's own, which is linked into this program: up to two where the memory was misused, one where it
// was allocated.
bool is_own_fault(const std::string& report) {
  constexpr int kInnermost = 3, kAllocating = 2;
  std::istringstream lines(report);
  int stack = 0, frame = 0, own_frames = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t start = line.find_first_not_of(' ');
    if (start == std::string::npos || line[start] != '#') continue;
    const bool is_innermost = line.compare(start, 3, "#0 ") == 0;
    stack += is_innermost;
    frame = is_innermost ? 0 : frame + 1;
    own_frames = (is_innermost ? 0 : own_frames) + is_of_program(line);
    const bool is_own_memory = stack > 1 && frame == kAllocating - 1 && is_of_program(line);
    if (is_own_memory || (stack == 1 && frame == kInnermost - 1 && own_frames == kInnermost)) return true;
  }
  return report.find("runtime error:") != std::string::npos;
}

}  // namespace cleave::fuzz
