// manifest.json: what ran, with what, on what, and how it ended. Written when the run starts (state
// "running") and again when it ends ("complete", "interrupted" or "failed"), each time under a temporary name
// that is then renamed, so that a reader never sees half of it. A manifest that says "running" with no such
// process is that of a killed run.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "harness/base/column.h"
#include "harness/base/option_value.h"
#include "harness/files/build_info.h"

namespace cleave {

constexpr const char* kManifestSchema = "cleave-run-1";
inline constexpr const char* kManifestFile = "manifest.json";
// What lies beside it.
inline constexpr const char* kStepsFile = "steps.csv";
inline constexpr const char* kMotionFile = "motion.h5";  // of run --record-motion

// What is known before the work begins.
struct WorkDescription {
  std::string command;
  std::vector<std::string> argv;
  std::string run_id;
  std::vector<OptionValue> options;  // all of the command, with their values
  std::vector<NamedAlgorithm> algorithms;
  std::string steps_schema;  // what the columns of steps.csv mean
  std::vector<Column> columns;
  std::vector<std::string> files;  // that the command may leave beside manifest and checksums
  std::vector<std::pair<std::string, std::string>> libraries;  // beside those of build_info.h
  double memory_limit_gb = 0;  // of a factorisation, 1e9 bytes; given or found
};

// What came out.
struct WorkResult {
  bool interrupted = false;
  std::vector<std::pair<std::string, double>> counts;  // NaN and infinities become null
};

class Manifest {
 public:
  Manifest(std::filesystem::path path, WorkDescription description);

  // Does the work between the two writings. When the work throws, the manifest says "failed" and why, and the
  // exception goes on. Where a full disk does not take the second writing, "failed" alone stands in the
  // first.
  void around(const std::function<WorkResult()>& work);

 private:
  // These throw std::runtime_error naming the file and the reason.
  void write_start();
  // message: why, of state "failed"; empty else.
  void write_end(const std::string& state, const WorkResult& result, const std::string& message);
  void write(const std::string& state, const WorkResult* result, const std::string& message) const;

  std::filesystem::path path_;
  WorkDescription description_;
  MachineInfo machine_;                     // at the start
  std::array<double, 3> load_average_end_;  // by then mostly the run's own
  std::string utc_start_;
  std::string utc_end_;
};

}  // namespace cleave
