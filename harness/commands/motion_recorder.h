// `cleave run --record-motion`: turns observed steps into the plain data of motion.h5 (files/motion_file.h).
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "harness/experiment/options.h"
#include "harness/experiment/simulation.h"
#include "harness/files/motion_file.h"

namespace cleave {

class MotionRecorder {
 public:
  // Creates nothing on disk.
  MotionRecorder(std::filesystem::path path, const RunOptions& options);
  ~MotionRecorder();

  // One step before the world is advanced. The first call creates the file. Throws std::runtime_error when it
  // cannot be written, and std::invalid_argument for more than kMostMotionBodies bodies.
  void record(const ObservedStep& step);

  // Writes what is left and closes the file.
  void finish();

 private:
  MotionSetup setup(const ObservedStep& step) const;

  std::filesystem::path path_;
  RunOptions options_;
  std::vector<std::string> labels_;  // of the combinations
  std::unique_ptr<MotionFile> file_;
};

}  // namespace cleave
