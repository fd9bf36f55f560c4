// A problem file is read in a child process: its coverage counters are made memory that parent and child
// share, so that the fuzzer, which looks at the parent's, sees what the child reached.
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <vector>

// The counters' section, as the linker names its ends.
extern "C" std::uint8_t __start___sancov_cntrs[], __stop___sancov_cntrs[];

// A crash in a child is told by its report, not by its signal, which says nothing about whose fault it was.
// Its frames name their module also where they have names of functions (child_reports.cpp).
extern "C" const char* __asan_default_options() {
  return "handle_segv=2:handle_sigbus=2:handle_sigfpe=2:handle_sigill=2:"
         "stack_trace_format='    #%n %p (%m+%o) %F %L'";
}

// Whole pages only: what else lies on the first and the last one is no counter.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
  const std::uintptr_t first =
      (reinterpret_cast<std::uintptr_t>(__start___sancov_cntrs) + page - 1) / page * page;
  const std::uintptr_t last = reinterpret_cast<std::uintptr_t>(__stop___sancov_cntrs) / page * page;
  if (first >= last) return 0;
  auto* const begin = reinterpret_cast<std::uint8_t*>(first);
  const std::vector<std::uint8_t> counters(begin, begin + (last - first));
  void* const shared =
      ::mmap(begin, counters.size(), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS | MAP_FIXED, -1, 0);
  if (shared == MAP_FAILED) std::abort();
  std::memcpy(begin, counters.data(), counters.size());
  return 0;
}
