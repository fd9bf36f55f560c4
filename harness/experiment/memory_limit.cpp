#include "harness/experiment/memory_limit.h"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>

#include "solver/memory_count.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

// The number after a word in a file of lines "word number ..."; none where it is not there.
std::uint64_t number_after(const fs::path& path, const std::string& word, std::uint64_t none) {
  std::ifstream file(path);
  for (std::string found; file >> found; file.ignore(std::numeric_limits<std::streamsize>::max(), '\n')) {
    std::uint64_t number = 0;
    if (found == word && file >> number) return number;
    file.clear();
  }
  return none;
}

std::uint64_t number_in(const fs::path& path, std::uint64_t none) {
  std::uint64_t number = 0;
  return std::ifstream(path) >> number ? number : none;  // "max" is none
}

std::uint64_t less(std::uint64_t limit, std::uint64_t used) { return limit > used ? limit - used : 0; }

// What a group and those above it leave; the file cache that they could drop is theirs to give.
std::uint64_t left_by_groups(const fs::path& root) {
  const fs::path top = root / "sys/fs/cgroup";
  std::ifstream groups(root / "proc/self/cgroup");
  std::uint64_t left = kNoMemoryLimit;
  for (std::string line; std::getline(groups, line);) {
    if (!line.starts_with("0::/")) continue;
    for (fs::path group = fs::path(line.substr(4)).lexically_normal();; group = group.parent_path()) {
      const fs::path directory = top / group;
      const std::uint64_t most = number_in(directory / "memory.max", kNoMemoryLimit);
      const std::uint64_t cache = number_after(directory / "memory.stat", "inactive_file", 0);
      const std::uint64_t used = less(number_in(directory / "memory.current", 0), cache);
      if (most != kNoMemoryLimit) left = std::min(left, less(most, used));
      if (group.empty()) break;
    }
  }
  return left;
}

std::uint64_t left_of_address_space(const fs::path& root) {
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kNoMemoryLimit;
  return less(limit.rlim_cur, 1024 * number_after(root / "proc/self/status", "VmSize:", 0));
}

}  // namespace

std::uint64_t available_memory_bytes(const fs::path& root) {
  constexpr std::uint64_t kNone = kNoMemoryLimit / 1024;
  const std::uint64_t of_machine = number_after(root / "proc/meminfo", "MemAvailable:", kNone);
  return std::min({of_machine == kNone ? kNoMemoryLimit : 1024 * of_machine, left_by_groups(root),
                   left_of_address_space(root)});
}

std::uint64_t memory_limit_bytes(double given_gb) {
  constexpr double kMost = 9.2e18;  // below which every double has its whole number
  if (!std::isnan(given_gb))
    return 1e9 * given_gb < kMost ? static_cast<std::uint64_t>(std::llround(1e9 * given_gb)) : kNoMemoryLimit;
  const std::uint64_t available = available_memory_bytes();
  return available == kNoMemoryLimit ? available : available / 10 * 9;
}

}  // namespace cleave
