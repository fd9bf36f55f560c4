// manifest.json: what ran, with what, on what, and how it ended. Written when the run starts (state
// "running") and again when it ends ("complete", "interrupted" or "failed"), each time under a temporary name
// that is then renamed, so that a reader never sees half of it. A manifest that says "running" with no such
// process is that of a killed run.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "harness/build_info.h"
#include "harness/options.h"
#include "harness/run_summary.h"

namespace cleave {

class Manifest {
 public:
  // options: all of the command, with their values.
  Manifest(std::filesystem::path path, std::string command, std::vector<std::string> argv,
           std::vector<OptionValue> options);

  // Does the work between the two writings and returns its summary. When the work throws, the manifest says
  // "failed" and why, and the exception goes on.
  RunSummary around(const std::function<RunSummary()>& work);

 private:
  // These throw std::runtime_error naming the file and the reason.
  void write_start();
  // message: why, of state "failed"; empty else.
  void write_end(const std::string& state, const RunSummary& summary, const std::string& message);
  void write(const std::string& state, const RunSummary* summary, const std::string& message) const;

  std::filesystem::path path_;
  std::string command_;
  std::vector<std::string> argv_;
  std::vector<OptionValue> options_;
  MachineInfo machine_;                     // at the start
  std::array<double, 3> load_average_end_;  // by then mostly the run's own
  std::string utc_start_;
  std::string utc_end_;
};

}  // namespace cleave
