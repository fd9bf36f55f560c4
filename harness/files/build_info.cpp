#include "harness/files/build_info.h"

#include <camd.h>
#include <elf.h>
#include <hdf5.h>
#include <link.h>
#ifdef CLEAVE_METIS
#include <metis.h>
#endif
#include <omp.h>
#include <stdlib.h>
#include <unistd.h>
#include <CLI/Version.hpp>
#include <Eigen/Core>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <limits>

#ifdef CLEAVE_SCOTCH
#include <scotch.h>  // needs cstdint and cstdio
#endif

#include "harness/base/hash.h"
#include "harness/files/dense_speed.h"
#include "harness/files/hdf5_types.h"
#include "solver/dispatch_cost.h"

// Written by build_info.cmake; a build without it says "unknown".
#if __has_include("cleave_build_info.h")
#include "cleave_build_info.h"
#else
#define CLEAVE_VERSION "unknown"
#define CLEAVE_GIT_HASH "unknown"
#define CLEAVE_GIT_DIRTY "unknown"
#define CLEAVE_COMPILE_FLAGS "unknown"
#define CLEAVE_BUILD_TYPE "unknown"
#endif

namespace cleave {
namespace {

std::string cpu_model() {
  std::ifstream cpuinfo("/proc/cpuinfo");
  for (std::string line; std::getline(cpuinfo, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

std::string governor() {
  std::ifstream file("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor");
  std::string name;
  return file >> name ? name : "unknown";
}

std::vector<std::pair<std::string, std::string>> omp_environment() {
  std::vector<std::pair<std::string, std::string>> variables;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string text = *entry;
    const std::size_t equals = text.find('=');
    if (text.starts_with("OMP_") && equals != std::string::npos)
      variables.emplace_back(text.substr(0, equals), text.substr(equals + 1));
  }
  std::ranges::sort(variables);
  return variables;
}

std::string dotted(int major, int minor, int patch) {
  return std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(patch);
}

// Of Clang __VERSION__ may begin with who packed it: "Debian Clang".
std::string compiler() {
#ifdef __clang__
  return "Clang " + dotted(__clang_major__, __clang_minor__, __clang_patchlevel__);
#else
  return "GCC " __VERSION__;
#endif
}

// The bytes of the note that holds the fingerprint, in one segment of notes; empty where it is not there.
std::string build_id_in(const char* notes, std::size_t size) {
  const auto padded = [](std::size_t bytes) { return (bytes + 3) / 4 * 4; };
  for (std::size_t place = 0; place + sizeof(ElfW(Nhdr)) <= size;) {
    const auto* note = reinterpret_cast<const ElfW(Nhdr)*>(notes + place);
    const std::size_t name = place + sizeof *note, bytes = name + padded(note->n_namesz);
    if (note->n_type == NT_GNU_BUILD_ID && std::string(notes + name) == "GNU")
      return {notes + bytes, note->n_descsz};
    place = bytes + padded(note->n_descsz);
  }
  return {};
}

// Of the first object that is loaded, which is the program.
int take_build_id(dl_phdr_info* object, std::size_t, void* into) {
  for (int k = 0; k < object->dlpi_phnum; ++k) {
    const ElfW(Phdr)& segment = object->dlpi_phdr[k];
    if (segment.p_type != PT_NOTE) continue;
    const std::string id =
        build_id_in(reinterpret_cast<const char*>(object->dlpi_addr + segment.p_vaddr), segment.p_memsz);
    if (!id.empty()) *static_cast<std::string*>(into) = id;
  }
  return 1;
}

std::string program_build_id() {
  std::string bytes, digits;
  ::dl_iterate_phdr(take_build_id, &bytes);
  for (const unsigned char byte : bytes) {
    char pair[3];
    digits.append(pair, std::snprintf(pair, sizeof pair, "%02x", byte));
  }
  return digits.empty() ? "unknown" : digits;
}

}  // namespace

BuildInfo build_info() {
  return {CLEAVE_VERSION,       CLEAVE_GIT_HASH,   CLEAVE_GIT_DIRTY,  compiler(),
          CLEAVE_COMPILE_FLAGS, CLEAVE_BUILD_TYPE, program_build_id()};
}

std::string build_key(const BuildInfo& build) {
  Fnv1a64 hash;
  for (const std::string& part :
       {build.git_hash, build.git_dirty, build.compiler, build.flags, build.build_type})
    hash.add(part + "\n");
  if (build.git_dirty != "false") hash.add(build.build_id);
  return hex(hash.value());
}

std::string version_text(const BuildInfo& build) {
  const std::string state =
      build.git_dirty == "true" ? "dirty" : (build.git_dirty == "false" ? "clean" : "unknown");
  return "cleave " + build.version + " (commit " + build.git_hash + ", " + state + ") " + build.compiler;
}

std::vector<std::pair<std::string, std::string>> library_versions() {
  unsigned hdf5[3];
  silence_hdf5();
  H5get_libversion(&hdf5[0], &hdf5[1], &hdf5[2]);
  std::vector<std::pair<std::string, std::string>> versions = {
      {"eigen", dotted(EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
      {"suitesparse", dotted(SUITESPARSE_MAIN_VERSION, SUITESPARSE_SUB_VERSION, SUITESPARSE_SUBSUB_VERSION)},
      {"camd", dotted(CAMD_MAIN_VERSION, CAMD_SUB_VERSION, CAMD_SUBSUB_VERSION)},
      {"hdf5", dotted(static_cast<int>(hdf5[0]), static_cast<int>(hdf5[1]), static_cast<int>(hdf5[2]))},
      {"openmp", std::to_string(_OPENMP)},
      {"cli11", CLI11_VERSION}};
#ifdef CLEAVE_METIS
  versions.emplace_back("metis", dotted(METIS_VER_MAJOR, METIS_VER_MINOR, METIS_VER_SUBMINOR));
#endif
#ifdef CLEAVE_SCOTCH
  versions.emplace_back("scotch", dotted(SCOTCH_VERSION, SCOTCH_RELEASE, SCOTCH_PATCHLEVEL));
#endif
  return versions;
}

std::array<double, 3> load_average() {
  std::array<double, 3> load{};
  if (::getloadavg(load.data(), 3) != 3) load.fill(std::numeric_limits<double>::quiet_NaN());
  return load;
}

MachineInfo machine_info() {
  MachineInfo info;
  info.host = host_name();
  info.cpu_model = cpu_model();
  info.cores = omp_get_num_procs();
  info.governor = governor();
  info.load_average = load_average();
  info.omp_threads = omp_get_max_threads();
  info.omp_environment = omp_environment();
  info.dense_kernel = dense_instruction_set();
  info.dense_gflop_per_s = dense_gflop_per_s();
  info.dispatch = dispatch_cost();
  return info;
}

std::string host_name() {
  char host[256] = "";
  return ::gethostname(host, sizeof host - 1) == 0 ? host : "unknown";
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  ::gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

}  // namespace cleave
