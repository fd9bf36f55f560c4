// Which sources, compiler and libraries this program was made of, and which machine it runs on.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "solver/stage_times.h"

namespace cleave {

// Of the sources at build time: "unknown" where they are no git checkout.
struct BuildInfo {
  std::string version;
  std::string git_hash;
  std::string git_dirty;  // "true", "false" or "unknown"
  std::string compiler;
  std::string flags;
  std::string build_type;
  std::string build_id;  // the linker's fingerprint of this program; "unknown" where it gave none
};
BuildInfo build_info();

// Fingerprint of what decides what a program computes: commit, compiler, flags and build type of clean
// sources, which any machine can make again; of sources with local changes the program itself.
std::string build_key(const BuildInfo& build);

// "cleave 0.2.0 (commit 0123..., clean) GCC 12.2.0"; "dirty" where the sources differ from the commit.
std::string version_text(const BuildInfo& build);

// Of all but ODE: name and version as the library reports it at run time where it can, else as its headers
// do.
std::vector<std::pair<std::string, std::string>> library_versions();

// Over 1, 5 and 15 minutes; NaN where the system does not say.
std::array<double, 3> load_average();

struct MachineInfo {
  std::string host;
  std::string cpu_model;
  int cores = 0;         // logical ones that this process may use
  std::string governor;  // of the first core's frequency; "unknown" where the system does not say
  std::array<double, 3> load_average{};
  int omp_threads = 0;
  std::vector<std::pair<std::string, std::string>> omp_environment;  // OMP_* as set, by name
  std::string dense_kernel;
  double dense_gflop_per_s = 0;
  DispatchCost dispatch;
};
// Measures the dense kernel and, once a process, the dispatch of tasks: about 30 ms.
MachineInfo machine_info();

std::string host_name();  // "unknown" where the system does not say

// Now, as 2024-01-31T12:00:00Z.
std::string utc_now();

}  // namespace cleave
