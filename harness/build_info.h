// Which sources, compiler and libraries this program was made of, and which machine it runs on.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace cleave {

// Of the sources at build time: "unknown" where they are no git checkout.
struct BuildInfo {
  std::string version;
  std::string git_hash;
  std::string git_dirty;  // "true", "false" or "unknown"
  std::string compiler;
  std::string flags;
  std::string build_type;
};
BuildInfo build_info();

// "cleave 0.2.0 (commit 0123..., clean) GCC 12.2.0"; "dirty" where the sources differ from the commit.
std::string version_text(const BuildInfo& build);

// Name and version as the library reports it at run time where it can, else as its headers do.
std::vector<std::pair<std::string, std::string>> library_versions();

struct MachineInfo {
  std::string host;
  std::string cpu_model;
  int cores = 0;                         // logical ones that this process may use
  std::array<double, 3> load_average{};  // over 1, 5 and 15 minutes; NaN where the system does not say
  int omp_threads = 0;
};
MachineInfo machine_info();

// Now, as 2024-01-31T12:00:00Z.
std::string utc_now();

}  // namespace cleave
